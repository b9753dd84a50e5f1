// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/shape.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace convexcut::robust {
namespace {

// A voxel alone has a normal only when a surface fills it.
constexpr std::int32_t kManyPoints = 12;

// Looks all of them up before any is used, so that they come into the cache together.
void collect(const VoxelMap& map, VoxelKey key, Around& found) noexcept {
  const Neighbourhood around(map, key);
  std::size_t count = 0;
  for (std::uint8_t step = 0; step < Neighbourhood::kCount; ++step) {
    const std::int32_t index = around.at(step);
    // Without a branch: which of them are occupied is as good as random.
    const auto at_least_0 = static_cast<std::size_t>(std::max(index, 0));
    found.moments[count] = &map.voxels()[at_least_0].moments;
    found.step[count] = step;
    count += index != VoxelMap::kNone ? 1U : 0U;
  }
  found.count = count;
  for (std::size_t k = 0; k < count; ++k) __builtin_prefetch(found.moments[k]);
}

void set_shape(Voxel& voxel, const ShapeColumns& shapes, std::size_t i) noexcept {
  voxel.shape = shapes.is_plane[i] != 0  ? Shape::plane
                : shapes.is_line[i] != 0 ? Shape::line
                                         : Shape::other;
  if (voxel.shape == Shape::other) {
    voxel.direction = Vec3f::Zero();
  } else {
    voxel.direction = Vec3f(shapes.x[i], shapes.y[i], shapes.z[i]);
  }
}

}  // namespace

void take_shapes(VoxelMap& map, std::span<const std::uint32_t> voxels) noexcept {
  std::array<Around, kShapesAtOnce> around;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    collect(map, map.voxels()[voxels[i]].key, around[i]);
  }
  ShapeColumns wide;
  take_shapes(std::span(around).first(voxels.size()), wide);
  std::array<std::size_t, kShapesAtOnce> alone;
  std::size_t alone_count = 0;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    Voxel& voxel = map.voxels()[voxels[i]];
    set_shape(voxel, wide, i);
    if (voxel.shape == Shape::plane || voxel.moments.count <= kManyPoints) continue;
    around[alone_count].moments[0] = &voxel.moments;
    around[alone_count].step[0] = Around::kMiddle;
    around[alone_count].count = 1;
    alone[alone_count++] = i;
  }
  if (alone_count == 0) return;
  ShapeColumns narrow;
  take_shapes(std::span(around).first(alone_count), narrow);
  for (std::size_t k = 0; k < alone_count; ++k) {
    if (narrow.is_plane[k] != 0) set_shape(map.voxels()[voxels[alone[k]]], narrow, k);
  }
}

}  // namespace convexcut::robust
