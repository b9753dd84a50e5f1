// SPDX-License-Identifier: Apache-2.0
//
// Where rays pass planes, compiled for every instruction set (core/simd). All give the same bits:
// no fused multiply-add, and sums in Eigen's order. RT: no allocation, no lock, no system call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/rays.hpp"

namespace convexcut::robust {

// Rays that end at least behind_m behind a plane and begin at least in_front_m before it.
struct Passages {
  std::size_t count = 0;
  // Which they are, and where they pass it: the cell of its grid, and along it.
  std::array<std::uint32_t, kRaysAtOnce + 64> ray;
  std::array<std::int32_t, kRaysAtOnce + 64> column, cell;
  std::array<float, kRaysAtOnce + 64> along_m;
};

// Of rays [begin, begin + kRaysAtOnce), those that pass within the plane's rectangle of cells.
void find_passages(const Rays& rays, std::size_t begin, const Plane& plane, const PlaneGrid& grid,
                   float behind_m, float in_front_m, Passages& passages) noexcept;

}  // namespace convexcut::robust
