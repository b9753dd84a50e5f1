// SPDX-License-Identifier: Apache-2.0
//
// What RobustCut keeps from call to call equals what is made anew from the same revolutions, and no
// instruction set changes a label. Says nothing about what the labels are worth.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
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

// A block of voxels ten wide and deep that begins at x = place, with one point each.
[[nodiscard]] VoxelMap block_at(std::int32_t place, std::int32_t voxels) {
  VoxelMap map(static_cast<std::size_t>(voxels));
  for (std::int32_t v = 0; v < voxels; ++v) {
    const Lattice at{place + v % 10, v / 10 % 10, v / 100};
    const auto index = static_cast<std::size_t>(map.find_or_add(robust::key_of(at)));
    map.voxels()[index].moments.add_mm(1, 0, 0);
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

TEST(RobustWindow, VoxelsStayInPlaceUntilTheNextRevolutionIsAddedAsUsual) {
  constexpr std::size_t kVoxels = 400;
  std::mt19937 random(9);
  Window usual(6, kVoxels, 20 * kVoxels);
  Window in_place(6, kVoxels, 20 * kVoxels);
  for (int i = 0; i < 60; ++i) {
    const VoxelMap revolution = random_revolution(random, 2 * i, kVoxels);
    usual.add(revolution, Vec3f::Zero(), 6);
    if (i % 5 != 4) {
      const std::vector<Voxel> before(in_place.map().voxels().begin(),
                                      in_place.map().voxels().end());
      ASSERT_TRUE(in_place.add_in_place(revolution, Vec3f::Zero(), 6));
      for (std::size_t v = 0; v < before.size(); ++v) {
        ASSERT_EQ(in_place.map().voxels()[v].key, before[v].key);
        ASSERT_EQ(in_place.map().voxels()[v].direction, before[v].direction);
      }
      for (std::size_t v = 0; v < revolution.size(); ++v) {
        const auto merged = static_cast<std::size_t>(in_place.merged(v));
        ASSERT_EQ(in_place.map().voxels()[merged].key, revolution.voxels()[v].key);
      }
    } else {
      in_place.add(revolution, Vec3f::Zero(), 6);
      ASSERT_EQ(sums_of(in_place.map()), sums_of(usual.map())) << i;
    }
    ASSERT_EQ(in_place.revolutions(), usual.revolutions());
  }
}

TEST(RobustWindow, AddsNothingInPlaceWhereThereIsNoRoom) {
  constexpr std::int32_t kVoxels = 1'000;
  Window window(6, kVoxels, 2 * kVoxels - 1);
  ASSERT_TRUE(window.add_in_place(block_at(0, kVoxels), Vec3f::Zero(), 6));
  EXPECT_FALSE(window.add_in_place(block_at(10, kVoxels), Vec3f::Zero(), 6));
  EXPECT_EQ(window.revolutions(), 1U);
  EXPECT_EQ(sums_of(window.map()), sums_of(block_at(0, kVoxels)));
}

TEST(RobustWindow, LooksUpWhatIsKnownOfARevolution) {
  constexpr std::int32_t kVoxels = 1'000;
  Window window(6, kVoxels, 6 * kVoxels);
  window.add(block_at(0, kVoxels), Vec3f::Zero(), 6);
  const VoxelMap next = block_at(3, kVoxels);
  window.look_up(next);
  std::size_t known = 0;
  for (std::size_t v = 0; v < next.size(); ++v) {
    ASSERT_EQ(window.merged(v), window.map().find(next.voxels()[v].key));
    known += window.merged(v) != VoxelMap::kNone ? 1U : 0U;
  }
  EXPECT_EQ(known, 7U * kVoxels / 10);
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

TEST(RobustWindow, KeepsFewerRevolutionsOfARigThatLeavesThemBehind) {
  constexpr std::int32_t kVoxels = 1'000;
  Window window(8, kVoxels, 4 * kVoxels + 1);
  for (std::int32_t i = 0; i < 20; ++i) {
    window.add(block_at(10 * i, kVoxels), Vec3f::Zero(), 8);
    ASSERT_EQ(window.revolutions(), static_cast<std::uint32_t>(std::min(i + 1, 4)));
    for (std::size_t v = 0; v < kVoxels; ++v) ASSERT_NE(window.merged(v), VoxelMap::kNone);
  }
}

// A large floor that is a little uneven.
constexpr std::int32_t kFloorEdge = 144;
constexpr std::size_t kFloorVoxels = std::size_t{kFloorEdge} * kFloorEdge;
static_assert(kFloorVoxels > Window::kLargeMap);

[[nodiscard]] VoxelMap uneven_floor(std::mt19937& random, int points_of_a_voxel) {
  const auto any = [&](std::int32_t most) {
    return std::uniform_int_distribution<std::int32_t>(-most, most)(random);
  };
  VoxelMap map(kFloorVoxels);
  for (std::int32_t v = 0; v < kFloorEdge * kFloorEdge; ++v) {
    const auto index = static_cast<std::size_t>(
        map.find_or_add(robust::key_of({v % kFloorEdge, v / kFloorEdge, 0})));
    for (int i = 0; i < points_of_a_voxel; ++i) {
      map.voxels()[index].moments.add_mm(any(95), any(95), any(10));
    }
  }
  return map;
}

// Thirty revolutions of one, of which none equals the one that it takes the place of.
class RobustShapesOfAFloor : public ::testing::Test {
 protected:
  RobustShapesOfAFloor() {
    for (int i = 0; i < 7; ++i) floors_.push_back(uneven_floor(random_, 12));
    for (int i = 0; i < 32; ++i) add_next();
  }
  // Which voxels have another direction then.
  std::vector<bool> add(const VoxelMap& revolution) {
    const std::vector<Voxel> before(window_.map().voxels().begin(), window_.map().voxels().end());
    window_.add(revolution, Vec3f::Zero(), 30);
    std::vector<bool> changed;
    for (std::size_t v = 0; v < before.size(); ++v) {
      changed.push_back(before[v].direction != window_.map().voxels()[v].direction);
    }
    return changed;
  }
  std::vector<bool> add_next() { return add(floors_[next_++ % floors_.size()]); }

  std::mt19937 random_{3};
  std::vector<VoxelMap> floors_;
  std::size_t next_ = 0;
  Window window_{30, kFloorVoxels, 2 * kFloorVoxels};
};

TEST_F(RobustShapesOfAFloor, AreTakenInTurnsWhereTheyHardlyChange) {
  std::vector<int> times(kFloorVoxels);
  for (int i = 0; i < 8; ++i) {
    const std::vector<bool> changed = add_next();
    EXPECT_LT(std::ranges::count(changed, true), kFloorVoxels * 2 / 5) << i;
    for (std::size_t v = 0; v < kFloorVoxels; ++v) times[v] += changed[v] ? 1 : 0;
  }
  EXPECT_GE(std::ranges::min(times), 2);
}

TEST_F(RobustShapesOfAFloor, AreTakenAtOnceWhereTheyChangeMuch) {
  const std::vector<bool> changed = add(uneven_floor(random_, 200));
  EXPECT_EQ(std::ranges::count(changed, true), kFloorVoxels);
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
