// SPDX-License-Identifier: Apache-2.0
//
// Planes by consensus: random trials, each with the plane through one surfel, the best refined by
// least squares; then the next among the surfels that are left (after Fischler and Bolles, "Random
// Sample Consensus", 1981, with one surfel and its normal as the sample).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/surfel_kernels.hpp"
#include "core/workspace.hpp"

namespace convexcut::robust {

// Fits by surfels have to rest on that many: about half a square metre.
inline constexpr std::uint32_t kLeastSurfels = 12;

// Of the planes that are level and face upwards, the one of most surfels; null without any.
[[nodiscard]] const Plane* largest_floor(const Model& model) noexcept;
// Upwards: the normal of that, or z where there is none.
[[nodiscard]] Vec3f up_of(const Model& model) noexcept;

class PlaneSearch {
 public:
  static constexpr std::size_t kMostPlanes = 48;

  // Allocates about 120 bytes a surfel.
  explicit PlaneSearch(std::size_t max_surfels);

  // Fills model.planes and the planes of the surfels. The same trials on every call.
  void run(Model& model, const Vec3f& origin) noexcept;

 private:
  void take_left(Model& model) noexcept;
  [[nodiscard]] const SurfelColumns& sample() noexcept;
  [[nodiscard]] Plane best_trial(const Model& model) noexcept;
  [[nodiscard]] std::uint32_t refine(Plane& plane) noexcept;
  [[nodiscard]] std::uint32_t separated(Plane& plane, std::uint32_t count) noexcept;
  [[nodiscard]] std::uint32_t fit(Plane& plane, std::span<const float> gates_m) noexcept;
  void claim(Model& model, const Plane& plane) noexcept;
  static void square_walls(Model& model) noexcept;
  [[nodiscard]] std::size_t random_left() noexcept;

  SurfelColumns left_;     // surfels without a plane
  SurfelColumns near_;     // of these, those near the plane that is refined
  SurfelColumns sampled_;  // those that trials are tested on, where these are not all
  Workspace<std::uint64_t> agree_;
  Workspace<std::uint32_t> taken_;
  std::uint64_t random_ = 0;
};

}  // namespace convexcut::robust
