// SPDX-License-Identifier: Apache-2.0
//
// The occupied cubes of a cloud with the sums of their points, found by a hash of their place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_cut/robust/moments.hpp"
#include "core/geometry.hpp"

namespace convexcut::robust {

inline constexpr float kVoxelM = 0.2F;

// A voxel's place on the lattice, 21 bits an axis: ±200 km.
using VoxelKey = std::uint64_t;
using Lattice = std::array<std::int32_t, 3>;

[[nodiscard]] VoxelKey key_of(const Lattice& place) noexcept;
[[nodiscard]] Lattice place_of(VoxelKey key) noexcept;
[[nodiscard]] Lattice place_of(const Vec3f& point) noexcept;
[[nodiscard]] Vec3f centre_of(const Lattice& place) noexcept;

// What the neighbourhood of a voxel looks like.
enum class Shape : std::uint8_t {
  other,  // too few points, or none of the two
  line,   // one ring of the lidar on a surface: the direction lies in the surface
  plane,  // the direction is the surface's normal
};

struct Voxel {
  VoxelKey key = 0;
  Moments moments;
  std::uint32_t revolution = 0;  // the newest that has points in it
  Vec3f direction = Vec3f::Zero();
  Shape shape = Shape::other;
  bool changed = true;  // since the shape was taken

  [[nodiscard]] Vec3f mean() const noexcept { return centre_of(place_of(key)) + moments.mean_m(); }
};

class VoxelMap {
 public:
  static constexpr std::int32_t kNone = -1;

  // Allocates for that many voxels: about 90 bytes each.
  explicit VoxelMap(std::size_t capacity);

  void clear() noexcept;
  [[nodiscard]] std::int32_t find(VoxelKey key) const noexcept;
  // Its index; a new empty voxel where there is none; kNone when the map is full.
  [[nodiscard]] std::int32_t find_or_add(VoxelKey key) noexcept;
  // Removes the voxels without points. Indices change.
  void remove_empty() noexcept;

  [[nodiscard]] std::span<Voxel> voxels() noexcept { return voxels_; }
  [[nodiscard]] std::span<const Voxel> voxels() const noexcept { return voxels_; }
  [[nodiscard]] std::size_t size() const noexcept { return voxels_.size(); }

 private:
  [[nodiscard]] std::size_t home_of(VoxelKey key) const noexcept;

  std::vector<std::int32_t> slots_;  // index of a voxel or kNone; a power of two of them
  std::vector<Voxel> voxels_;
};

// Calls visit(index, offset) for the voxel and its 26 neighbours, those that are occupied; offset
// in lattice steps.
template <class Visit>
void for_each_neighbour(const VoxelMap& map, VoxelKey key, Visit&& visit) noexcept {
  const Lattice at = place_of(key);
  for (std::int32_t x = -1; x <= 1; ++x) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      for (std::int32_t z = -1; z <= 1; ++z) {
        const std::int32_t index = map.find(key_of({at[0] + x, at[1] + y, at[2] + z}));
        if (index != VoxelMap::kNone) visit(static_cast<std::size_t>(index), Lattice{x, y, z});
      }
    }
  }
}

}  // namespace convexcut::robust
