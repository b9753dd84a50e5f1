// SPDX-License-Identifier: Apache-2.0
//
// What was decided of places that have gone out of the window. A tilted lidar that turns sees them
// again half a turn later, and at first only little of them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/convex_cut/robust/verdicts.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

// A cache of sets: where one is full, what came to it first is forgotten first. One thread. RT, but
// for the constructor.
class VerdictMemory {
 public:
  // Allocates 17 to 34 bytes a voxel.
  explicit VerdictMemory(std::size_t voxels) : sets_(std::bit_ceil(voxels / kWays + 1)) {}

  void clear() noexcept { std::fill(sets_.begin(), sets_.end(), Set{}); }

  void put(VoxelKey key, const Verdicts& verdicts) noexcept {
    Set& set = sets_[slot_of(key, sets_.size())];
    std::size_t way = way_of(set, key);
    if (way == kWays) way = set.next++ % kWays;
    set.keys.at(way) = key;
    set.verdicts.at(way) = verdicts;
  }
  // Those of no revolution where nothing is known.
  [[nodiscard]] Verdicts find(VoxelKey key) const noexcept {
    const Set& set = sets_[slot_of(key, sets_.size())];
    const std::size_t way = way_of(set, key);
    return way == kWays ? Verdicts{} : set.verdicts.at(way);
  }

 private:
  static constexpr std::size_t kWays = 7;
  struct Set {
    std::array<VoxelKey, kWays> keys{};  // 0 is beyond the lattice's limit
    std::array<Verdicts, kWays> verdicts{};
    std::size_t next = 0;  // to be replaced
  };

  [[nodiscard]] static std::size_t way_of(const Set& set, VoxelKey key) noexcept {
    return static_cast<std::size_t>(std::find(set.keys.begin(), set.keys.end(), key) -
                                    set.keys.begin());
  }

  std::vector<Set> sets_;  // a power of two of them
};

}  // namespace convexcut::robust
