// SPDX-License-Identifier: Apache-2.0
//
// What RobustCut keeps from call to call equals what is made anew from the same revolutions; and no
// instruction set changes a label. Says nothing about what the labels are worth.
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <random>
#include <set>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/window.hpp"
#include "core/simd/simd_path.hpp"
#include "tests/core/convex_cut/robust/room_cut.hpp"

namespace convexcut {
namespace {

using robust::Lattice;
using robust::Voxel;
using robust::VoxelKey;
using robust::VoxelMap;
using robust::Window;
using Sums = std::array<std::int32_t, 10>;

[[nodiscard]] Sums sums_of(const Voxel& voxel) {
  const robust::Moments& m = voxel.moments;
  Sums sums{m.count, m.sum_mm[0], m.sum_mm[1], m.sum_mm[2]};
  std::copy(m.products_mm2.begin(), m.products_mm2.end(), sums.begin() + 4);
  return sums;
}

[[nodiscard]] std::map<VoxelKey, Sums> sums_of(const VoxelMap& map) {
  std::map<VoxelKey, Sums> all;
  for (const Voxel& voxel : map.voxels()) all[voxel.key] = sums_of(voxel);
  return all;
}

// Surfaces and scattered points; from place to place, as a rig goes on, and around zero.
[[nodiscard]] VoxelMap random_revolution(std::mt19937& random, std::int32_t place,
                                         std::size_t capacity) {
  const auto any = [&](std::int32_t from, std::int32_t to) {
    return std::uniform_int_distribution<std::int32_t>(from, to)(random);
  };
  VoxelMap map(capacity);
  for (int points = any(1, 600); points > 0; --points) {
    const bool scattered = any(0, 9) == 0;
    const Lattice at{place + any(-6, 6), any(-6, 6), scattered ? any(-40, 40) : any(-1, 1)};
    const std::int32_t index = map.find_or_add(robust::key_of(at));
    if (index == VoxelMap::kNone) continue;
    map.voxels()[static_cast<std::size_t>(index)].moments.add_mm(any(-100, 100), any(-100, 100),
                                                                 any(-100, 100));
  }
  return map;
}

// The neighbours are those that find() finds, in the lattice's order.
void expect_neighbourhoods_right(const VoxelMap& map) {
  for (const Voxel& voxel : map.voxels()) {
    std::vector<std::int32_t> visited;
    robust::for_each_neighbour(map, voxel.key, [&](std::size_t index, const Lattice& step) {
      const Lattice at = robust::place_of(voxel.key);
      EXPECT_EQ(map.voxels()[index].key,
                robust::key_of({at[0] + step[0], at[1] + step[1], at[2] + step[2]}));
      visited.push_back(9 * step[0] + 3 * step[1] + step[2]);
    });
    std::size_t found = 0;
    for (const Voxel& other : map.voxels()) {
      const Lattice a = robust::place_of(voxel.key);
      const Lattice b = robust::place_of(other.key);
      found +=
          std::abs(a[0] - b[0]) <= 1 && std::abs(a[1] - b[1]) <= 1 && std::abs(a[2] - b[2]) <= 1
              ? 1U
              : 0U;
    }
    ASSERT_EQ(visited.size(), found);
    ASSERT_TRUE(std::is_sorted(visited.begin(), visited.end()));
    ASSERT_EQ(&map.voxels()[static_cast<std::size_t>(map.find(voxel.key))], &voxel);
  }
}

TEST(RobustWindow, EqualsTheSumOfItsRevolutionsWhereverTheRigGoes) {
  constexpr std::size_t kVoxels = 400;  // the last revolutions do not all find room
  std::mt19937 random(5);
  Window window(6, kVoxels, 6 * kVoxels);
  std::deque<VoxelMap> kept;
  for (int i = 0; i < 120; ++i) {
    const std::uint32_t keep = i % 7 == 6 ? 2 : 6;
    kept.push_back(random_revolution(random, 3 * i * (i % 50 < 25 ? 1 : -1), kVoxels));
    while (kept.size() > keep) kept.pop_front();
    window.add(kept.back(), Vec3f::Zero(), keep);
    ASSERT_EQ(window.revolutions(), kept.size()) << i;
    std::map<VoxelKey, Sums> expected;
    for (const VoxelMap& revolution : kept) {
      for (const auto& [key, sums] : sums_of(revolution)) {
        Sums& sum = expected[key];
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += sums[k];
      }
    }
    std::erase_if(expected, [](const auto& entry) { return entry.second[0] == 0; });
    ASSERT_EQ(sums_of(window.map()), expected) << i;
    if (i % 20 == 19) expect_neighbourhoods_right(window.map());
  }
}

TEST(RobustWindow, KeepsFewerRevolutionsThatHaveMoreVoxelsThanUsual) {
  constexpr std::int32_t kEdge = 25;  // 15,625 voxels each
  constexpr std::size_t kVoxels = kEdge * kEdge * kEdge;
  Window window(5, kVoxels, 2 * kVoxels);
  for (std::int32_t i = 0; i < 12; ++i) {
    VoxelMap revolution(kVoxels);
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(kVoxels); ++v) {
      const Lattice at{v % kEdge, v / kEdge % kEdge, v / (kEdge * kEdge)};
      const auto index = static_cast<std::size_t>(revolution.find_or_add(robust::key_of(at)));
      revolution.voxels()[index].moments.add_mm(1, i, 0);
    }
    window.add(revolution, Vec3f::Zero(), 5);
    const std::int32_t kept = std::min(i + 1, 4);
    ASSERT_EQ(window.revolutions(), static_cast<std::uint32_t>(kept));
    for (const Voxel& voxel : window.map().voxels()) {
      ASSERT_EQ(voxel.moments.count, kept);
      ASSERT_EQ(voxel.moments.sum_mm[1], kept * i - kept * (kept - 1) / 2);
    }
  }
}

TEST(RobustCut, EveryInstructionSetGivesTheSameLabels) {
  test::BoxRoom room;
  room.boxes = {{{1.0, 0.5, -0.5}, {2.2, 1.3, -0.45}}, {{3.6, -1.0, -1.2}, {4.0, 1.0, 0.6}}};
  room.has_mirror = true;
  std::set<std::vector<Label>> all;
  for (const std::string_view path : simd_paths()) {
    ASSERT_TRUE(use_simd_path(path));
    all.insert(test::cut(room, {.tilt_deg = 30.0, .ghosts = 0.02}, 4).labels);
  }
  ASSERT_TRUE(use_simd_path("auto"));
  EXPECT_EQ(all.size(), 1U);
}

}  // namespace
}  // namespace convexcut
