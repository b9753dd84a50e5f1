// SPDX-License-Identifier: Apache-2.0
//
// Shapes of many neighbourhoods at once, with the same bits on every instruction set: the
// arithmetic of Eigen's closed form for 3 × 3 matrices, operation by operation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_cut/robust/moments.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

inline constexpr std::size_t kShapesAtOnce = 16;

// Voxels around one, itself among them.
struct Around {
  static constexpr std::size_t kMost = Neighbourhood::kCount;
  static constexpr std::uint8_t kMiddle = kMost / 2;
  std::array<const Moments*, kMost> moments;
  std::array<std::uint8_t, kMost> step;  // as Neighbourhood::step_of takes it
  std::size_t count = 0;
};

struct ShapeColumns {
  using Column = std::array<float, kShapesAtOnce>;
  alignas(64) Column x{}, y{}, z{};                    // unit; see Shape
  std::array<std::int32_t, kShapesAtOnce> is_plane{};  // not 0: it is
  std::array<std::int32_t, kShapesAtOnce> is_line{};   // not 0: it is, and no plane
};

// Of at most kShapesAtOnce neighbourhoods, by the principal axes of their points. RT: no
// allocation, no lock, no system call.
void take_shapes(std::span<const Around> around, ShapeColumns& shapes) noexcept;

}  // namespace convexcut::robust
