// SPDX-License-Identifier: Apache-2.0
//
// Planes by consensus: random trials, each with the plane through one surfel, the best refined by
// least squares; then the next among the surfels that are left (after Fischler and Bolles, "Random
// Sample Consensus", 1981, with one surfel and its normal as the sample).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/convex_cut/robust/model.hpp"

namespace convexcut::robust {

// A surfel agrees with a plane only when it is this near.
inline constexpr float kPlaneGateM = 0.06F;

// Fits by surfels have to rest on that many: about half a square metre.
inline constexpr std::uint32_t kLeastSurfels = 12;

// Position and direction.
[[nodiscard]] bool agrees(const Surfel& surfel, const Plane& plane, float gate_m) noexcept;

class PlaneSearch {
 public:
  static constexpr std::size_t kMostPlanes = 48;

  explicit PlaneSearch(std::size_t max_surfels) {
    left_.reserve(max_surfels);
    near_.reserve(max_surfels);
  }

  // Fills model.planes and the planes of the surfels. The same trials on every call.
  void run(Model& model, const Vec3f& origin) noexcept;

 private:
  [[nodiscard]] Plane best_trial(const Model& model) noexcept;
  [[nodiscard]] std::uint32_t refine(const Model& model, Plane& plane) noexcept;
  void claim(Model& model, const Plane& plane) noexcept;
  void drop_near(const Model& model, const Plane& plane) noexcept;
  [[nodiscard]] std::size_t random_left() noexcept;

  std::vector<std::uint32_t> left_;  // surfels without a plane
  std::vector<std::uint32_t> near_;  // of these, those near the plane that is refined
  std::uint64_t random_ = 0;
};

}  // namespace convexcut::robust
