// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

// The sills, jambs and heads of windows and doors: too narrow to be planes of their own, they join
// a wall to what lies parallel behind it, and are as much of the wall as these. Of an opening only
// the jambs are known, beside which rays go through the wall.
class Recesses {
 public:
  using Id = std::uint8_t;
  static constexpr Id kNone = 255;

  // Among the accepted planes. RT: no allocation.
  void find(const Model& model) noexcept;

  // The recess that a piece of surface is a side of. band_m: as in RobustParameters.
  [[nodiscard]] Id recess_of(const Model& model, const PlaneGrids& grids, const Surfel& surfel,
                             float band_m) const noexcept;

  // Whether p lies between the wall and what is behind it, or on either.
  [[nodiscard]] bool holds(const Model& model, Id recess, const Vec3f& p,
                           float band_m) const noexcept;

 private:
  static constexpr std::size_t kMost = 32;
  static constexpr std::uint8_t kNothing = 255;
  struct Recess {
    std::uint8_t wall = 0, behind = 0;  // planes; kNothing: an opening
  };
  std::array<Recess, kMost> recesses_{};
  std::size_t count_ = 0;
};

}  // namespace convexcut::robust
