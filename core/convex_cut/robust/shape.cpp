// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/shape.hpp"

#include <array>
#include <cstddef>

namespace convexcut::robust {
namespace {

// A voxel alone has a normal only when a surface fills it.
constexpr std::int32_t kManyPoints = 12;

// The occupied voxels around one, in their order.
struct Neighbours {
  std::array<std::uint32_t, Neighbourhood::kSize> index;
  std::array<std::uint8_t, Neighbourhood::kSize> step;  // from the corner on
  std::size_t count = 0;
};

// Looks all of them up before any is used, so that they come into the cache together.
void collect(const VoxelMap& map, VoxelKey key, Neighbours& found) noexcept {
  const Neighbourhood around(map, key);
  std::uint8_t step = 0;
  std::size_t count = 0;
  for (std::uint32_t x = 0; x < 3; ++x) {
    for (std::uint32_t y = 0; y < 3; ++y) {
      for (std::uint32_t z = 0; z < 3; ++z, ++step) {
        const std::int32_t index = around.at(x, y, z);
        found.index[count] = static_cast<std::uint32_t>(index);
        found.step[count] = step;
        count += index != VoxelMap::kNone ? 1U : 0U;
      }
    }
  }
  found.count = count;
  for (std::size_t k = 0; k < count; ++k) {
    __builtin_prefetch(&map.voxels()[found.index[k]].moments);
  }
}

// By step from the corner on.
constexpr auto kShifts = [] {
  std::array<Spread::Shift, Neighbourhood::kSize> shifts;
  for (std::size_t step = 0; step < shifts.size(); ++step) {
    const auto offset_m = [](std::size_t at) { return (static_cast<float>(at) - 1.0F) * kVoxelM; };
    shifts[step] = Spread::Shift(offset_m(step / 9), offset_m(step / 3 % 3), offset_m(step % 3));
  }
  return shifts;
}();

[[nodiscard]] Spread spread_of(const VoxelMap& map, const Neighbours& neighbours) noexcept {
  Spread around;
  for (std::size_t k = 0; k < neighbours.count; ++k) {
    around.add(map.voxels()[neighbours.index[k]].moments, kShifts[neighbours.step[k]]);
  }
  return around;
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
  std::array<Neighbours, kShapesAtOnce> neighbours;
  SpreadColumns spreads;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    collect(map, map.voxels()[voxels[i]].key, neighbours[i]);
  }
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    spread_of(map, neighbours[i]).store(spreads, i);
  }
  ShapeColumns wide;
  take_shapes(spreads, wide);
  std::array<std::size_t, kShapesAtOnce> alone;
  std::size_t alone_count = 0;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    Voxel& voxel = map.voxels()[voxels[i]];
    set_shape(voxel, wide, i);
    if (voxel.shape == Shape::plane || voxel.moments.count <= kManyPoints) continue;
    Spread spread;
    spread.add(voxel.moments);
    spread.store(spreads, alone_count);
    alone[alone_count++] = i;
  }
  if (alone_count == 0) return;
  ShapeColumns narrow;
  take_shapes(spreads, narrow);
  for (std::size_t k = 0; k < alone_count; ++k) {
    if (narrow.is_plane[k] != 0) set_shape(map.voxels()[voxels[alone[k]]], narrow, k);
  }
}

}  // namespace convexcut::robust
