// SPDX-License-Identifier: Apache-2.0
//
// The occupied cubes of a cloud with the sums of their points, found by a hash of their place.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/convex_cut/robust/moments.hpp"
#include "core/convex_cut/robust/verdicts.hpp"
#include "core/geometry.hpp"

namespace convexcut::robust {

inline constexpr float kVoxelM = 0.2F;

// A voxel's place on the lattice, 21 bits an axis: ±200 km.
using VoxelKey = std::uint64_t;
using Lattice = std::array<std::int32_t, 3>;
// Far outside of the lattice all is one border: such points have no neighbours to agree with.
inline constexpr std::int32_t kLatticeBias = 1 << 20;
inline constexpr auto kLatticeLimit = static_cast<float>(kLatticeBias - 2);

[[nodiscard]] constexpr VoxelKey key_of(const Lattice& place) noexcept {
  const auto part = [](std::int32_t c) {
    return static_cast<VoxelKey>(c + kLatticeBias) & 0x1F'FFFF;
  };
  return (part(place[0]) << 42U) | (part(place[1]) << 21U) | part(place[2]);
}
// Where to look for it first among so many slots, a power of two and at most 2²⁴.
[[nodiscard]] constexpr std::size_t slot_of(VoxelKey key, std::size_t slots) noexcept {
  constexpr VoxelKey kGolden = 0x9E3779B97F4A7C15U;  // Fibonacci hashing (Knuth, vol. 3, 6.4)
  return static_cast<std::size_t>((key * kGolden) >> 40U) & (slots - 1);
}
[[nodiscard]] inline Lattice place_of(VoxelKey key) noexcept {
  const auto part = [](VoxelKey bits) {
    return static_cast<std::int32_t>(bits & 0x1F'FFFF) - kLatticeBias;
  };
  return {part(key >> 42U), part(key >> 21U), part(key)};
}

[[nodiscard]] inline Lattice place_of(const Vec3f& point) noexcept {
  const auto step = [](float c) {
    return static_cast<std::int32_t>(
        std::clamp(std::floor(c / kVoxelM), -kLatticeLimit, kLatticeLimit));
  };
  return {step(point.x()), step(point.y()), step(point.z())};
}

[[nodiscard]] inline Vec3f centre_of(const Lattice& place) noexcept {
  const auto middle = [](std::int32_t c) { return (static_cast<float>(c) + 0.5F) * kVoxelM; };
  return {middle(place[0]), middle(place[1]), middle(place[2])};
}

// What the neighbourhood of a voxel looks like.
enum class Shape : std::uint8_t {
  other,  // too few points, or none of the two
  line,   // one ring of the lidar on a surface: the direction lies in the surface
  plane,  // the direction is the surface's normal
  strip,  // so it is, but of the voxel with those above and below it: other surfaces are beside
};

[[nodiscard]] constexpr bool has_normal(Shape shape) noexcept {
  return shape == Shape::plane || shape == Shape::strip;
}

struct Voxel {
  VoxelKey key = 0;
  Moments moments;
  std::uint32_t revolution = 0;  // the newest that has points in it
  Vec3f direction = Vec3f::Zero();
  std::uint32_t place = 0;  // among those of the map
  Shape shape = Shape::other;
  std::uint16_t changed = 0;  // points that came or went since the shape was taken
  Verdicts verdicts;

  [[nodiscard]] Vec3f mean() const noexcept { return centre_of(place_of(key)) + moments.mean_m(); }
  void change(const Moments& by, std::int32_t sign) noexcept {
    moments.add(by, sign);
    constexpr std::int32_t kMost = std::numeric_limits<std::uint16_t>::max();
    changed = static_cast<std::uint16_t>(std::min(changed + by.count, kMost));
  }
};

// The voxels lie in the order of their addition. The hash is of blocks of 4 × 4 × 4 of them: a
// voxel's neighbourhood is in one to eight blocks.
class VoxelMap {
 public:
  static constexpr std::int32_t kNone = -1;

  // Allocates for that many voxels, in a quarter as many blocks (surfaces fill them with ten and
  // more): about 160 bytes a voxel.
  explicit VoxelMap(std::size_t capacity);

  void clear() noexcept;
  [[nodiscard]] std::int32_t find(VoxelKey key) const noexcept {
    return block_at(key)[place_in_block(key)];
  }
  // Its index; a new empty voxel where there is none; kNone when the map is full.
  [[nodiscard]] std::int32_t find_or_add(VoxelKey key) noexcept;
  // Removes the voxels without points, and calls visit(voxel) for each. Indices change.
  template <class Visit>
  void remove_empty(Visit&& visit) noexcept;

  [[nodiscard]] std::span<Voxel> voxels() noexcept { return voxels_; }
  [[nodiscard]] std::span<const Voxel> voxels() const noexcept { return voxels_; }
  [[nodiscard]] std::size_t size() const noexcept { return voxels_.size(); }
  [[nodiscard]] std::size_t capacity() const noexcept { return voxels_.capacity(); }

  // The indices of the voxels in the block that the key lies in, each kNone where there is none.
  [[nodiscard]] const std::int32_t* block_at(VoxelKey key) const noexcept {
    const VoxelKey block = block_of(key);
    const std::size_t home = home_of(block);
    if ((is_home_[home / kBits] >> home % kBits & 1U) == 0) return empty_block();
    for (std::size_t i = home;; i = (i + 1) & (slots_.size() - 1)) {
      const Slot& slot = slots_[i];
      if (slot.block == block || slot.block == kFree) return &places_[slot.first_place];
    }
  }
  [[nodiscard]] const std::int32_t* empty_block() const noexcept { return places_.data(); }
  [[nodiscard]] static constexpr std::size_t place_in_block(VoxelKey key) noexcept {
    return ((key >> 38U) & 48U) | ((key >> 19U) & 12U) | (key & 3U);
  }

 private:
  static constexpr std::size_t kBlock = 64;  // voxels
  static constexpr std::size_t kBits = 64;
  static constexpr VoxelKey kFree = 1;  // no block's: the lowest bits of theirs are zero
  struct Slot {
    VoxelKey block = kFree;
    std::uint32_t first_place = 0;  // of a free slot, those of the empty block
  };

  [[nodiscard]] static constexpr VoxelKey block_of(VoxelKey key) noexcept {
    constexpr VoxelKey kWithin = (VoxelKey{3} << 42U) | (VoxelKey{3} << 21U) | 3U;
    return key & ~kWithin;
  }
  [[nodiscard]] std::size_t home_of(VoxelKey block) const noexcept {
    return slot_of(block, slots_.size());
  }
  [[nodiscard]] std::size_t find_or_add_block(VoxelKey key) noexcept;
  void put(std::size_t voxel, std::size_t block_begin) noexcept;
  void lay_out_anew() noexcept;

  std::vector<Slot> slots_;                 // a power of two of them
  std::vector<std::uint64_t> is_home_;      // a bit a slot: of any block; small enough for a cache
  std::vector<std::int32_t> places_;        // by block; the first block stays empty
  std::vector<std::uint8_t> block_voxels_;  // how many are in each
  std::size_t empty_blocks_ = 0;
  std::vector<Voxel> voxels_;
};

template <class Visit>
void VoxelMap::remove_empty(Visit&& visit) noexcept {
  std::size_t kept = 0;
  for (const Voxel& voxel : voxels_) {
    if (voxel.moments.count > 0) {
      places_[voxel.place] = static_cast<std::int32_t>(kept);
      voxels_[kept++] = voxel;
    } else {
      visit(voxel);
      places_[voxel.place] = kNone;
      if (--block_voxels_[voxel.place / kBlock] == 0) ++empty_blocks_;
    }
  }
  voxels_.resize(kept);
  // Blocks stay where they are, and what moved on leaves empty ones behind.
  if (2 * empty_blocks_ > block_voxels_.size()) lay_out_anew();
}

// Where the voxels are that lie around one, itself among them: those of up to eight blocks.
class Neighbourhood {
 public:
  static constexpr std::size_t kCount = 27;  // steps along z first, then y, then x
  [[nodiscard]] static constexpr Lattice step_of(std::size_t k) noexcept {
    const auto step = static_cast<std::int32_t>(k);
    return {step / 9 - 1, step / 3 % 3 - 1, step % 3 - 1};
  }

  Neighbourhood(const VoxelMap& map, VoxelKey key) noexcept {
    constexpr VoxelKey kX = VoxelKey{1} << 42U;
    constexpr VoxelKey kY = VoxelKey{1} << 21U;
    const VoxelKey first = key - kX - kY - 1;  // the corner; keys add up as places do
    const std::size_t corner = VoxelMap::place_in_block(first);
    sites_ = kSites[corner].data();
    // Three steps from 2 or 3 on reach into the next block.
    for (std::uint32_t x = 0; x <= corner >> 5U; ++x) {
      for (std::uint32_t y = 0; y <= (corner >> 3U & 1U); ++y) {
        for (std::uint32_t z = 0; z <= (corner >> 1U & 1U); ++z) {
          const std::int32_t* block = map.block_at(first + 4 * (x * kX + y * kY + z));
          is_empty_ = is_empty_ && block == map.empty_block();
          blocks_[4 * x + 2 * y + z] = block;
        }
      }
    }
  }
  // For sure.
  [[nodiscard]] bool is_empty() const noexcept { return is_empty_; }
  // The index of the voxel step_of(k) from the middle one; VoxelMap::kNone where there is none.
  [[nodiscard]] std::int32_t at(std::size_t k) const noexcept {
    return blocks_[sites_[k].block][sites_[k].place];
  }

 private:
  struct Site {
    std::uint8_t block;  // of blocks_
    std::uint8_t place;  // in it
  };
  using Sites = std::array<Site, kCount>;
  // By the corner's place in its block.
  static constexpr std::array<Sites, 64> kSites = [] {
    std::array<Sites, 64> all{};
    for (std::size_t corner = 0; corner < all.size(); ++corner) {
      for (std::size_t k = 0; k < kCount; ++k) {
        const std::size_t x = corner / 16 + k / 9;
        const std::size_t y = corner / 4 % 4 + k / 3 % 3;
        const std::size_t z = corner % 4 + k % 3;
        all[corner][k] = {static_cast<std::uint8_t>(x / 4 * 4 + y / 4 * 2 + z / 4),
                          static_cast<std::uint8_t>(x % 4 * 16 + y % 4 * 4 + z % 4)};
      }
    }
    return all;
  }();

  std::array<const std::int32_t*, 8> blocks_{};  // from the corner on, and those that follow
  const Site* sites_;
  bool is_empty_ = true;
};

// Whether test(index, offset) is true of the voxel or one of its 26 neighbours, as far as they are
// occupied; offset in lattice steps. Ends with the first.
template <class Test>
[[nodiscard]] bool any_neighbour(const VoxelMap& map, VoxelKey key, Test&& test) noexcept {
  const Neighbourhood around(map, key);
  if (around.is_empty()) return false;
  for (std::size_t k = 0; k < Neighbourhood::kCount; ++k) {
    const std::int32_t index = around.at(k);
    if (index == VoxelMap::kNone) continue;
    if (test(static_cast<std::size_t>(index), Neighbourhood::step_of(k))) return true;
  }
  return false;
}

// Calls visit(index, offset) for all of them.
template <class Visit>
void for_each_neighbour(const VoxelMap& map, VoxelKey key, Visit&& visit) noexcept {
  static_cast<void>(any_neighbour(map, key, [&](std::size_t index, const Lattice& offset) {
    visit(index, offset);
    return false;
  }));
}

}  // namespace convexcut::robust
