// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/convex_cut/robust/moments.hpp"
#include "core/convex_cut/robust/shape_kernels.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

// Fewer points in a voxel are no surface: an isolated return (a ghost, rain, a mixed pixel).
inline constexpr std::int32_t kSupport = 3;

// Sets shape and direction of at most kShapesAtOnce voxels, by their indices: those of the points
// of a voxel and its neighbours, wide enough for two rings of the lidar, and a precise normal.
// Where these are no plane, those of the voxel alone; then of it with those above and below it.
void take_shapes(VoxelMap& map, std::span<const std::uint32_t> voxels) noexcept;

}  // namespace convexcut::robust
