// SPDX-License-Identifier: Apache-2.0
//
// How earlier decisions weigh, and that places are remembered which went out of the window. What
// that is worth is measured by bench/accuracy.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/verdict_memory.hpp"
#include "core/convex_cut/robust/verdicts.hpp"
#include "core/convex_cut/robust/window.hpp"
#include "tests/core/convex_cut/robust/room_cut.hpp"

namespace convexcut {
namespace {

using robust::Verdict;
using robust::VerdictMemory;
using robust::Verdicts;
using robust::VoxelKey;
using robust::VoxelMap;
using robust::Window;

// Adds these decisions: s for structure, o for an object.
Verdict add(Verdicts& verdicts, std::string_view decisions) {
  Verdict verdict = Verdict::as_now;
  for (const char decision : decisions) verdict = verdicts.add(decision == 's');
  return verdict;
}

// The last of the answers to them.
[[nodiscard]] Verdict verdict_after(std::string_view decisions) {
  Verdicts verdicts;
  return add(verdicts, decisions);
}
[[nodiscard]] Verdicts verdicts_of(std::string_view decisions) {
  Verdicts verdicts;
  add(verdicts, decisions);
  return verdicts;
}

// The last of those to what was decided once the place was back, after it had gone.
[[nodiscard]] Verdict verdict_after(std::string_view before, std::string_view decisions) {
  Verdicts back = verdicts_of(before).back();
  return add(back, decisions);
}

TEST(RobustVerdicts, TheFirstRevolutionDecidesAlone) {
  EXPECT_EQ(verdict_after("s"), Verdict::as_now);
  EXPECT_EQ(verdict_after("o"), Verdict::as_now);
}

TEST(RobustVerdicts, OneRevolutionChangesNothingAfterMany) {
  EXPECT_EQ(verdict_after("sssso"), Verdict::structure);
  EXPECT_EQ(verdict_after("oooos"), Verdict::object);
}

TEST(RobustVerdicts, TwoInARowMakeStructureAndHalfOfAllAnObject) {
  EXPECT_EQ(verdict_after("ooooooooss"), Verdict::as_now);
  EXPECT_EQ(verdict_after("ssssooo"), Verdict::structure);
  EXPECT_EQ(verdict_after("ssssoooo"), Verdict::as_now);
}

TEST(RobustVerdicts, WhatIsLongPastFades) {
  const std::string past(200, 's');
  EXPECT_EQ(verdict_after(past + std::string(10, 'o')), Verdict::structure);
  EXPECT_EQ(verdict_after(past + std::string(12, 'o')), Verdict::as_now);
}

TEST(RobustVerdicts, WhatWasDecidedBeforeAPlaceWentAwayWeighsHalfAsMuch) {
  const std::string structure(16, 's');
  EXPECT_EQ(verdict_after(structure, "o"), Verdict::structure_again);
  EXPECT_EQ(verdict_after(structure, std::string(7, 'o')), Verdict::structure_again);
  EXPECT_EQ(verdict_after(structure, std::string(8, 'o')), Verdict::as_now);
  EXPECT_EQ(verdict_after("ss", "o"), Verdict::structure_again);
  EXPECT_EQ(verdict_after("ss", "oo"), Verdict::as_now);  // and no more than it did
}

TEST(RobustVerdicts, TwoInARowMakeNoStructureOfAnObjectThatIsBack) {
  const std::string object(16, 'o');
  EXPECT_EQ(verdict_after(object, "ss"), Verdict::object);
  EXPECT_EQ(verdict_after(object, "sss"), Verdict::object);
  EXPECT_EQ(verdict_after(object, "ssss"), Verdict::as_now);
  EXPECT_EQ(verdict_after("", "ss"), Verdict::as_now);
}

// They are of structure: one that says otherwise is overruled.
[[nodiscard]] bool is_structure(Verdicts verdicts) {
  return verdicts.add(false) == Verdict::structure;
}

TEST(RobustVerdictMemory, KnowsTheNewestOfEachPlace) {
  VerdictMemory memory(100);
  EXPECT_TRUE(memory.find(5).is_empty());
  memory.put(5, verdicts_of("ssss"));
  memory.put(6, verdicts_of("oooo"));
  EXPECT_TRUE(is_structure(memory.find(5)));
  EXPECT_FALSE(memory.find(6).is_empty());
  EXPECT_FALSE(is_structure(memory.find(6)));
  memory.put(5, verdicts_of("oooo"));
  EXPECT_FALSE(is_structure(memory.find(5)));
  memory.clear();
  EXPECT_TRUE(memory.find(5).is_empty());
  EXPECT_TRUE(memory.find(6).is_empty());
}

TEST(RobustVerdictMemory, ForgetsOnlyTheOldestWhenItIsFull) {
  constexpr VoxelKey kPlaces = 100'000;
  constexpr VoxelKey kRoom = 1'000;
  VerdictMemory memory(kRoom);
  for (VoxelKey key = 1; key <= kPlaces; ++key) memory.put(key, verdicts_of("ssss"));
  VoxelKey known = 0;
  VoxelKey known_of_newest = 0;
  for (VoxelKey key = 1; key <= kPlaces; ++key) {
    if (memory.find(key).is_empty()) continue;
    ++known;
    known_of_newest += key > kPlaces - kRoom ? 1U : 0U;
  }
  EXPECT_GE(known, kRoom);
  EXPECT_LE(known, 3 * kRoom);
  EXPECT_GE(known_of_newest, kRoom * 9 / 10);  // sets are filled unevenly
}

// Floor, ceiling and walls of a room of 12 × 9 × 3 m: keys that differ in few of their bits.
[[nodiscard]] std::vector<VoxelKey> places_of_a_room() {
  constexpr robust::Lattice kSize{60, 45, 15};
  std::vector<VoxelKey> places;
  for (std::int32_t x = 0; x < kSize[0]; ++x) {
    for (std::int32_t y = 0; y < kSize[1]; ++y) {
      for (std::int32_t z = 0; z < kSize[2]; ++z) {
        const bool inside =
            x > 0 && y > 0 && z > 0 && x + 1 < kSize[0] && y + 1 < kSize[1] && z + 1 < kSize[2];
        if (!inside) places.push_back(robust::key_of({x, y, z}));
      }
    }
  }
  return places;
}

TEST(RobustVerdictMemory, KnowsAllOfARoomThatIsASixthOfIt) {
  const std::vector<VoxelKey> places = places_of_a_room();
  VerdictMemory memory(6 * places.size());
  for (const VoxelKey key : places) memory.put(key, verdicts_of("ssss"));
  std::size_t known = 0;
  for (const VoxelKey key : places) known += memory.find(key).is_empty() ? 0U : 1U;
  EXPECT_EQ(known, places.size());
}

// One voxel with points.
[[nodiscard]] VoxelMap revolution_at(VoxelKey key) {
  VoxelMap map(4);
  for (int i = 0; i < 10; ++i) {
    map.voxels()[static_cast<std::size_t>(map.find_or_add(key))].moments.add_mm(i, 0, 0);
  }
  return map;
}

class RobustWindowMemory : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kRevolutions = 3;
  static constexpr VoxelKey kPlace = robust::key_of({1, 2, 3});
  static constexpr VoxelKey kElsewhere = robust::key_of({40, 2, 3});

  // A revolution that sees this place alone.
  Verdict see(VoxelKey key, bool is_structure) {
    window.add(revolution_at(key), Vec3f::Zero(), kRevolutions);
    return window.judge(0, key, is_structure);
  }
  void see_as_structure(int times) {
    for (int i = 0; i < times; ++i) see(kPlace, true);
  }
  void look_elsewhere() {
    for (std::uint32_t i = 0; i < kRevolutions; ++i) see(kElsewhere, false);
    EXPECT_EQ(window.map().find(kPlace), VoxelMap::kNone);
  }

  Window window{kRevolutions, 4, 16};
};

TEST_F(RobustWindowMemory, KnowsAPlaceAgainThatWasOutOfIt) {
  see_as_structure(8);
  look_elsewhere();
  EXPECT_EQ(see(kPlace, false), Verdict::structure_again);
  look_elsewhere();
  EXPECT_EQ(see(kPlace, false), Verdict::structure_again);
}

TEST_F(RobustWindowMemory, KnowsItBeforeItIsAdded) {
  see_as_structure(8);
  look_elsewhere();
  for (int i = 0; i < 2; ++i) {  // that changes nothing
    window.look_up(revolution_at(kPlace));
    EXPECT_EQ(window.judge(0, kPlace, false), Verdict::structure_again);
  }
  EXPECT_EQ(see(kPlace, false), Verdict::structure_again);
  window.clear();
  window.look_up(revolution_at(kPlace));
  EXPECT_EQ(window.judge(0, kPlace, false), Verdict::as_now);
}

TEST_F(RobustWindowMemory, TakesWhatStayedInItForNoneOfThose) {
  see_as_structure(8);
  see(kElsewhere, false);
  EXPECT_EQ(see(kPlace, false), Verdict::structure);
}

TEST_F(RobustWindowMemory, RemembersNothingOfWhatWasHardlySeen) {
  see_as_structure(3);
  look_elsewhere();
  EXPECT_EQ(see(kPlace, false), Verdict::as_now);
}

TEST_F(RobustWindowMemory, StartsAnewWithNothing) {
  see_as_structure(8);
  look_elsewhere();
  window.clear();
  EXPECT_EQ(see(kPlace, false), Verdict::as_now);
}

// The share of the last box's points that is kept in revolutions [from, to) of a lidar that turns
// once in thirty, with a window of six.
[[nodiscard]] double kept_in(const test::BoxRoom& room, test::Sight sight, int from, int to,
                             bool at_once = false) {
  RobustCut robust({.window = 6}, test::kMostPoints);
  std::size_t all = 0;
  std::size_t kept = 0;
  for (int i = 0; i < to; ++i) {
    const test::LabelledCloud seen = test::revolution_in(room, sight);
    std::vector<Label> labels(seen.cloud.size(), Label::other);
    const CutStatus status = at_once ? robust.label_at_once(seen.cloud.view(), labels)
                                     : robust.label(seen.cloud.view(), labels);
    EXPECT_EQ(status, CutStatus::ok);
    EXPECT_EQ(robust.learn(), at_once && i > 0);  // the first was learnt from at once
    sight.yaw_deg += 12.0;
    ++sight.seed;
    for (std::size_t k = 0; i >= from && k < labels.size(); ++k) {
      if (seen.box[k] + 1 != static_cast<int>(room.boxes.size())) continue;
      ++all;
      kept += labels[k] == Label::structure ? 1U : 0U;
    }
  }
  EXPECT_GT(all, 100U);
  return static_cast<double>(kept) / static_cast<double>(all);
}

[[nodiscard]] test::BoxRoom high_room_with(const std::vector<test::RoomBox>& boxes) {
  test::BoxRoom room;
  room.walls = {{-4.0, -3.0, -1.2}, {4.0, 3.0, 3.0}};
  room.boxes = boxes;
  return room;
}

// When it comes into view there are so few points on it that they have no normal.
TEST(RobustReturn, APillarIsKnownAgainByItsFirstPoints) {
  const test::BoxRoom room = high_room_with({{{-2.9, -2.2, -1.2}, {-2.5, -1.8, 3.0}}});
  const test::Sight sight{.tilt_deg = 30.0, .firings = 400};
  EXPECT_LT(kept_in(room, sight, 19, 24), 0.8);
  EXPECT_GT(kept_in(room, sight, 49, 54), 0.93);
  EXPECT_LT(kept_in(room, sight, 19, 24, true), 0.8);
  EXPECT_GT(kept_in(room, sight, 49, 54, true), 0.9);
}

// Its front is in view before anything is seen over it.
TEST(RobustReturn, ACupboardIsNoWallAgain) {
  const test::BoxRoom room = high_room_with({{{-3.9, -2.2, -1.2}, {-3.4, -1.8, 3.0}},
                                             {{-3.2, -2.6, -1.2}, {-2.2, -1.0, 0.9}},
                                             {{2.0, 1.0, -1.2}, {3.6, 1.5, 1.0}},
                                             {{3.6, -1.0, -1.2}, {4.0, 0.5, 1.8}}});
  const test::Sight sight{.tilt_deg = 30.0};
  EXPECT_GT(kept_in(room, sight, 7, 9), 0.7);
  EXPECT_LT(kept_in(room, sight, 37, 39), test::kRemoved);
}

}  // namespace
}  // namespace convexcut
