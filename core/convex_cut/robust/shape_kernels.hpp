// SPDX-License-Identifier: Apache-2.0
//
// Shapes of many neighbourhoods at once, with the same bits on every instruction set: the
// arithmetic of Eigen's closed form for 3 × 3 matrices, operation by operation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace convexcut::robust {

inline constexpr std::size_t kShapesAtOnce = 16;

// See Spread: sums of coordinates in m, of their products in m².
struct SpreadColumns {
  using Column = std::array<float, kShapesAtOnce>;
  alignas(64) Column count{};
  Column x{}, y{}, z{};
  Column xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
};

struct ShapeColumns {
  using Column = std::array<float, kShapesAtOnce>;
  alignas(64) Column x{}, y{}, z{};                    // unit; see Shape
  std::array<std::int32_t, kShapesAtOnce> is_plane{};  // not 0: it is
  std::array<std::int32_t, kShapesAtOnce> is_line{};   // not 0: it is, and no plane
};

// By the principal axes of the points. RT: no allocation, no lock, no system call.
void take_shapes(const SpreadColumns& spreads, ShapeColumns& shapes) noexcept;

}  // namespace convexcut::robust
