// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/convex_cut/robust/moments.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

// Fewer points in a voxel are no surface: an isolated return (a ghost, rain, a mixed pixel).
inline constexpr std::int32_t kSupport = 3;

struct LocalShape {
  Shape shape = Shape::other;
  Vec3f direction = Vec3f::Zero();  // unit; see Shape
};

// By the principal axes of the points.
[[nodiscard]] LocalShape local_shape(const Spread& spread) noexcept;

// Of a voxel and its neighbours: wide enough for two rings of the lidar, and a precise normal.
[[nodiscard]] LocalShape shape_around(const VoxelMap& map, const Voxel& voxel) noexcept;

}  // namespace convexcut::robust
