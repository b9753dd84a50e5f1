// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace convexcut::robust {
namespace {

// A voxel alone has a normal only when a surface fills it.
constexpr std::int32_t kManyPoints = 12;
constexpr float kUpright = 0.35F;  // |z| of a normal

// Of a neighbourhood, where more than one surface is in all of it: the edge of a pillar, a sill.
enum class Part : std::uint8_t {
  alone,   // the voxel
  upright  // that, the one below it and the one above it
};

// The steps along z come first, so that these three follow each other.
static_assert(Neighbourhood::step_of(Around::kMiddle - 1) == Lattice{0, 0, -1} &&
              Neighbourhood::step_of(Around::kMiddle + 1) == Lattice{0, 0, 1});

void take_part(const Around& around, Part part, Around& found) noexcept {
  const std::uint8_t reach = part == Part::upright ? 1 : 0;
  std::size_t k = 0;
  while (around.step[k] + reach < Around::kMiddle) ++k;
  found.count = 0;
  for (; k < around.count && around.step[k] <= Around::kMiddle + reach; ++k) {
    found.moments[found.count] = around.moments[k];
    found.step[found.count++] = around.step[k];
  }
}

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

// plane: what one is called.
void set_shape(Voxel& voxel, const ShapeColumns& shapes, std::size_t i,
               Shape plane = Shape::plane) noexcept {
  voxel.shape = shapes.is_plane[i] != 0  ? plane
                : shapes.is_line[i] != 0 ? Shape::line
                                         : Shape::other;
  if (voxel.shape == Shape::other) {
    voxel.direction = Vec3f::Zero();
  } else {
    voxel.direction = Vec3f(shapes.x[i], shapes.y[i], shapes.z[i]);
  }
}

// Of the voxels that are no plane yet.
void take_shapes_of(Part part, VoxelMap& map, std::span<const std::uint32_t> voxels,
                    std::span<const Around> around) noexcept {
  std::array<Around, kShapesAtOnce> parts;
  std::array<std::uint32_t, kShapesAtOnce> of;
  std::size_t count = 0;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const Voxel& voxel = map.voxels()[voxels[i]];
    if (voxel.shape == Shape::plane) continue;
    if (part == Part::alone && voxel.moments.count <= kManyPoints) continue;
    take_part(around[i], part, parts[count]);
    of[count++] = voxels[i];
  }
  if (count == 0) return;
  ShapeColumns shapes;
  take_shapes(std::span(parts).first(count), shapes);
  for (std::size_t k = 0; k < count; ++k) {
    if (shapes.is_plane[k] == 0) continue;
    if (part == Part::alone) {
      set_shape(map.voxels()[of[k]], shapes, k);
    } else if (std::abs(shapes.z[k]) < kUpright) {
      set_shape(map.voxels()[of[k]], shapes, k, Shape::strip);
    }
  }
}

}  // namespace

void take_shapes(VoxelMap& map, std::span<const std::uint32_t> voxels) noexcept {
  std::array<Around, kShapesAtOnce> around;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    collect(map, map.voxels()[voxels[i]].key, around[i]);
  }
  ShapeColumns shapes;
  take_shapes(std::span(around).first(voxels.size()), shapes);
  for (std::size_t i = 0; i < voxels.size(); ++i) set_shape(map.voxels()[voxels[i]], shapes, i);
  take_shapes_of(Part::alone, map, voxels, around);
  take_shapes_of(Part::upright, map, voxels, around);
}

}  // namespace convexcut::robust
