// SPDX-License-Identifier: Apache-2.0
//
// The loops of the plane search over all surfels, compiled for every instruction set (core/simd).
// All give the same bits: no fused multiply-add, and sums in Eigen's order. RT: no allocation, no
// lock, no system call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_cut/robust/model.hpp"
#include "core/workspace.hpp"

namespace convexcut::robust {

// Surfels with a shape, each value a column of its own. Whole vectors are read and written: the
// columns go on for kPadding elements behind the last.
class SurfelColumns {
 public:
  static constexpr std::size_t kPadding = 64;

  explicit SurfelColumns(std::size_t capacity) : stride_(capacity + kPadding) {
    values_.resize(kColumns * stride_);
    index.resize(stride_);
  }
  [[nodiscard]] float* column(std::size_t i) noexcept { return values_.data() + i * stride_; }
  [[nodiscard]] const float* column(std::size_t i) const noexcept {
    return values_.data() + i * stride_;
  }

  // The mean, the direction, weight: of the surfel in a fit. bar: what |cos| to the plane's normal
  // has to exceed, or negative, to stay below (Shape::line).
  enum Column : std::size_t { kX, kY, kZ, kU, kV, kW, kBar, kWeight, kColumns };

  Workspace<std::uint32_t> index;  // in Model::surfels
  std::size_t size = 0;

 private:
  std::size_t stride_;
  Workspace<float> values_;
};

// How many of the surfels agree with each plane: at most gate_m from it, and along it. Several
// planes at once, so that a surfel is loaded for all of them.
inline constexpr std::size_t kPlanesAtOnce = 4;
using AgreeingCounts = std::array<std::size_t, kPlanesAtOnce>;
[[nodiscard]] AgreeingCounts count_agreeing(const SurfelColumns& surfels,
                                            const std::array<Plane, kPlanesAtOnce>& planes,
                                            float gate_m) noexcept;

// A bit for each surfel, lowest first; of the last word, those behind the end are 0.
void mark_agreeing(const SurfelColumns& surfels, const Plane& plane, float gate_m,
                   std::span<std::uint64_t> bits) noexcept;

// Copies those nearer to the plane than reach_m, in their order.
void copy_near(const SurfelColumns& surfels, const Plane& plane, float reach_m,
               SurfelColumns& near) noexcept;

// Takes those that agree out of the columns; the others stay in their order. Writes their indices,
// and up to kPadding values more, to `taken`; returns how many there are.
std::size_t take_agreeing(SurfelColumns& surfels, const Plane& plane, float gate_m,
                          std::uint32_t* taken) noexcept;

}  // namespace convexcut::robust
