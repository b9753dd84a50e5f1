// SPDX-License-Identifier: Apache-2.0
//
// One rule of RobustCut a test, in a small room where that rule decides. How often the rules are
// right in furnished rooms, and what they are worth together, is measured by bench/accuracy.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/robust_cut.hpp"
#include "tests/core/convex_cut/robust/room_cut.hpp"

namespace convexcut {
namespace {

using test::BoxRoom;
using test::cut;
using test::Kept;
using test::kKept;
using test::kMostlyRemoved;
using test::kRemoved;
using test::RoomBox;

// The floor of a corridor is out of view beneath the lidar; two cupboards hide what is beside the
// table.
TEST(RobustRules, RemovesATableBetweenTwoPartsOfTheFloor) {
  BoxRoom corridor;
  corridor.walls = {{-4.0, -1.3, -1.2}, {4.0, 1.3, 1.6}};
  corridor.boxes = {{{-0.6, 0.7, -0.6}, {0.6, 1.3, -0.5}},
                    {{-1.2, 0.7, -1.2}, {-0.6, 1.3, 0.2}},
                    {{0.6, 0.7, -1.2}, {1.2, 1.3, 0.2}}};
  EXPECT_LT(cut(corridor, {}).share_of(0), kMostlyRemoved);
}

// Of the floor only what is before the tilted lidar is in view. The table behind it stands between
// cupboards; the others, of its height, are passed around.
TEST(RobustRules, RemovesATableBesideTheFloorByOthersOfItsHeight) {
  BoxRoom room;
  room.walls = {{-3.0, -3.2, -1.25}, {3.0, 3.2, 1.65}};
  room.boxes = {{{-2.0, 1.2, -0.55}, {-1.0, 2.4, -0.52}},
                {{-3.0, 1.0, -1.25}, {-2.0, 2.6, -0.3}},
                {{-2.0, 2.4, -1.25}, {-1.0, 3.2, -0.3}},
                {{-0.2, -2.2, -0.55}, {1.8, -0.6, -0.52}},
                {{-0.2, 0.4, -0.55}, {1.6, 1.4, -0.52}}};
  EXPECT_LT(cut(room, {.tilt_deg = 30.0}).share_of(0), kRemoved);
}

TEST(RobustRules, RemovesTheUndersideOfAShelfAndKeepsThatOfABulkhead) {
  BoxRoom room;
  room.walls = {{-3.0, -3.0, -1.2}, {2.0, 3.0, 1.6}};
  room.boxes = {{{1.5, -0.6, 0.2}, {2.0, 0.6, 1.0}}};
  EXPECT_LT(cut(room, {.tilt_deg = 2.0}, 4).share_of(0), kRemoved);
  room.boxes = {{{1.2, -1.2, 0.2}, {2.0, 1.2, 1.0}}};
  EXPECT_GT(cut(room, {.tilt_deg = 2.0}, 4).share_of(0), kKept);
}

// A lidar that stands upright sees a low ceiling ring by ring in the distance.
TEST(RobustRules, KeepsSmallPartsOfACeilingThatNothingIsSeenAbove) {
  BoxRoom corridor;
  corridor.walls = {{-8.5, -1.2, -1.3}, {8.5, 1.2, 1.6}};
  corridor.boxes = {{{-8.5, -1.2, 1.1}, {8.5, 1.2, 1.6}}};
  EXPECT_GT(cut(corridor, {}, 4).share_of(0), kKept);
}

// From corner to corner, so that no wall is seen beside it.
TEST(RobustRules, RemovesAWideFrontOfBooksAndKeepsAFlatOne) {
  BoxRoom room;
  room.walls = {{-4.0, -2.0, -1.2}, {3.0, 2.0, 1.6}};
  for (const double uneven_m : {0.0, 0.03}) {
    room.boxes.clear();
    for (int i = 0; i < 50; ++i) {
      const double y = -2.0 + 0.08 * i;
      const double front = 2.6 + uneven_m * (i * 7 % 5 - 2) / 2.0;
      room.boxes.push_back({{front, y, -1.2}, {3.0, y + 0.08, 1.6}});
    }
    Kept kept = cut(room, {});
    for (int& box : kept.cloud.box) box = std::min(box, 0);
    if (uneven_m > 0.0) {
      EXPECT_LT(kept.share_of(0), kRemoved);
    } else {
      EXPECT_GT(kept.share_of(0), kKept);
    }
  }
}

// Of what a front of blocks, 0.3 m wide, is kept: by how much the next one is set back.
template <class SetBack>
double kept_of_blocks(double top_m, SetBack&& set_back_m) {
  BoxRoom room;
  room.walls = {{-4.0, -2.1, -1.2}, {3.0, 2.1, top_m}};
  for (int i = 0; i < 14; ++i) {
    const double y = -2.1 + 0.3 * i;
    room.boxes.push_back({{2.6 + set_back_m(i), y, -1.2}, {3.0, y + 0.3, top_m}});
  }
  Kept kept = cut(room, {});
  for (int& box : kept.cloud.box) box = std::min(box, 0);
  return kept.share_of(0);
}

TEST(RobustRules, TellsBooksFromAPanelByStepsFromCellToCell) {
  EXPECT_LT(kept_of_blocks(1.6, [](int i) { return i % 2 == 0 ? 0.0 : 0.04; }), kRemoved);
  EXPECT_GT(kept_of_blocks(1.6, [](int i) { return i < 7 ? 0.0 : 0.025; }), kKept);
}

TEST(RobustRules, AWallUpToTheCeilingMayBeRough) {
  const auto uneven_m = [](int i) { return 0.06 * (i % 2); };
  EXPECT_LT(kept_of_blocks(1.6, uneven_m), kMostlyRemoved);
  EXPECT_GT(kept_of_blocks(0.3, uneven_m), 0.5);  // some blocks are fixtures on it
}

TEST(RobustRules, KeepsALongWallWithThingsOnIt) {
  BoxRoom room;
  room.walls = {{-6.0, -2.0, -1.2}, {6.0, 2.4, 1.6}};
  for (int i = 0; i < 5; ++i) {
    const double x = -4.6 + 2.0 * i;
    room.boxes.push_back({{x, -2.0, -1.2}, {x + 0.6, -1.94, 1.6}});
  }
  EXPECT_GT(cut(room, {}).share_of(test::kWalls), 0.95);
}

// A chair's leg in the board's plane; what is beside that is hidden.
TEST(RobustRules, RemovesABoardThatStandsFreeBesideALeg) {
  BoxRoom room;
  room.boxes = {{{1.8, -0.8, -1.2}, {1.85, 0.8, 0.7}},
                {{1.8, 1.2, -1.2}, {1.85, 1.4, -0.6}},
                {{0.9, 0.72, -1.2}, {1.0, 1.3, 1.6}}};
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
  // With a leg on its other side as well, what is seen in its plane is wider than a screen.
  room.boxes.push_back({{1.8, -1.4, -1.2}, {1.85, -1.2, -0.6}});
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
}

// As tall as the board, in its plane: rays between them tell that they are two things.
TEST(RobustRules, RemovesABoardThatStandsFreeBesideACupboardInItsPlane) {
  BoxRoom room;
  room.boxes = {{{1.8, -0.8, -1.2}, {1.85, 0.8, 0.7}}, {{1.8, 1.3, -1.2}, {2.2, 1.9, 0.7}}};
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
}

// What is short and hangs alone is a lamp.
TEST(RobustRules, KeepsASmallPaneInThePlaneOfALargeOne) {
  BoxRoom room;
  room.boxes = {{{3.95, 1.2, 0.62}, {4.0, 2.1, 1.1}},  {{3.95, -2.6, 0.62}, {4.0, -0.4, 1.1}},
                {{3.8, -3.0, -1.2}, {4.0, 3.0, 0.62}}, {{3.8, -3.0, 1.1}, {4.0, 3.0, 1.6}},
                {{3.8, -3.0, 0.62}, {4.0, -2.6, 1.1}}, {{3.8, -0.4, 0.62}, {4.0, 1.2, 1.1}},
                {{3.8, 2.1, 0.62}, {4.0, 3.0, 1.1}}};
  EXPECT_GT(cut(room, {.tilt_deg = -8.0}, 2).share_of(0), 0.8);
}

// From wall to wall; what is over most of it is hidden by a board that hangs close to the lidar.
TEST(RobustRules, RemovesAPartitionThatIsLookedOverInAPart) {
  BoxRoom room;
  room.walls = {{-4.0, -1.5, -1.2}, {4.0, 1.5, 1.6}};
  room.boxes = {{{2.0, -1.5, -1.2}, {2.05, 1.5, 0.25}}, {{0.95, -0.4, 0.13}, {1.0, 0.8, 1.6}}};
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
}

// A twelfth of a counter's front is; a wall's top would not be below the lidar.
TEST(RobustRules, RemovesALowFrontThatIsLookedOverInASmallPart) {
  BoxRoom room;
  room.walls = {{-4.0, -4.0, -1.2}, {4.0, 4.0, 1.6}};
  room.boxes = {{{2.0, -4.0, -1.2}, {2.4, 3.0, -0.25}}, {{0.9, -2.0, -0.11}, {0.95, 1.18, 1.6}}};
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
  // It goes on behind a post.
  room.boxes.push_back({{0.9, 0.45, -1.2}, {0.95, 0.61, -0.11}});
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
}

// What is above it is hidden by a monitor.
TEST(RobustRules, RemovesTheSideOfADesk) {
  BoxRoom room;
  room.boxes = {{{1.8, -0.25, -1.2}, {2.3, 0.25, -0.3}}, {{1.0, -0.6, -0.16}, {1.1, 0.6, 1.6}}};
  EXPECT_LT(cut(room, {}).share_of(0), kMostlyRemoved);
}

// Books on the walls are no noise of the sensor, and a floor that is met at an angle shows less.
TEST(RobustRules, TheSensorsNoiseIsToldAlongTheBeam) {
  BoxRoom room;
  for (int i = 0; i < 40; ++i) {
    const double y = -3.0 + 0.15 * i;
    const double deep_m = 0.04 * (i % 3);
    room.boxes.push_back({{3.5 + deep_m, y, -1.2}, {4.0, y + 0.15, 1.6}});
    room.boxes.push_back({{-4.0, y, -1.2}, {-3.5 - deep_m, y + 0.15, 1.6}});
  }
  RobustCut robust({}, test::kMostPoints);
  (void)test::last_of(robust, room, {}, 1);
  EXPECT_NEAR(std::sqrt(robust.model().noise2), 0.02F, 0.003F);
}

// Rings of the lidar that lie in one plane with it, as a level one does whatever it meets.
TEST(RobustRules, WhatIsSeenAlongItselfIsNoSurface) {
  constexpr int kDisc = 0;
  test::LabelledCloud seen = test::revolution_in({}, {});
  for (int ring = 0; ring < 12; ++ring) {
    for (int i = 0; i < 120; ++i) {
      const double angle = 0.5 + 0.01 * i;
      const double range = 0.8 + 0.1 * ring;
      seen.cloud.add(range * std::cos(angle), range * std::sin(angle), 0.01 * ((i % 3) - 1));
      seen.box.push_back(kDisc);
    }
  }
  Kept kept{seen, std::vector<Label>(seen.cloud.size())};
  RobustCut robust({}, test::kMostPoints);
  ASSERT_EQ(robust.label(seen.cloud.view(), kept.labels), CutStatus::ok);
  EXPECT_LT(kept.share_of(kDisc), kRemoved);
  EXPECT_GT(kept.share_of(test::kWalls), 0.98);
}

// A board hangs a hand's breadth beside its upper corner; or its foot is hidden as well.
TEST(RobustRules, KeepsAShutDoorBesideABoardAndRemovesTheBoard) {
  BoxRoom room;
  room.walls = {{-3.0, -4.0, -1.2}, {7.0, 4.0, 1.6}};
  room.boxes = {{{6.96, -0.9, -1.2}, {7.0, 0.0, 0.85}}, {{6.97, 0.1, 0.6}, {7.0, 1.6, 1.1}}};
  for (const bool is_hidden : {false, true}) {
    if (is_hidden) room.boxes.push_back({{6.2, -1.2, -1.2}, {6.6, 0.4, -0.5}});
    const Kept kept = cut(room, {}, 6);
    EXPECT_GT(kept.share_of(0), 0.7) << is_hidden;  // but for the corner at the board
    EXPECT_LT(kept.share_of(1), kMostlyRemoved) << is_hidden;
  }
}

// Rays go through most of its columns, to a wall farther back, but over them it goes up to the
// ceiling.
TEST(RobustRules, KeepsAWallThatIsMostlyWindows) {
  BoxRoom room;
  room.walls = {{-4.0, -3.0, -1.2}, {6.0, 3.0, 1.6}};
  room.boxes = {{{3.0, -3.0, -1.2}, {3.1, 3.0, -0.3}}, {{3.0, -3.0, 0.6}, {3.1, 3.0, 1.6}}};
  const Kept kept = cut(room, {.tilt_deg = 30.0}, 18);
  EXPECT_GT(kept.share_of(0), kKept);
  EXPECT_GT(kept.share_of(1), kKept);
}

// Along a corridor, in the first revolution: rays get over it to the ceiling, through the upper
// part of the cells that its top is in, as they would through glass.
TEST(RobustRules, RemovesACupboardThatEndsWithinACell) {
  BoxRoom room;
  room.walls = {{-8.0, -1.1, -1.3}, {8.0, 1.1, 1.3}};
  for (const double top_m : {0.65, 0.7}) {
    room.boxes = {{{-0.85, -1.1, -1.3}, {0.85, -0.6, top_m}}};
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      EXPECT_LT(cut(room, {.tilt_deg = 60.0, .seed = seed}).share_of(0), kRemoved) << seed;
    }
  }
}

// They cover its upper half: the plane that fits both leans by more than a degree.
TEST(RobustRules, AWallBelowBoardsIsUpright) {
  BoxRoom room;
  room.boxes = {{{3.96, -2.6, 0.0}, {4.0, 2.6, 0.8}}, {{3.9999, -2.9, -0.9}, {4.0, 2.9, -0.6}}};
  const Kept kept = cut(room, {}, 6);
  EXPECT_LT(kept.share_of(0), kMostlyRemoved);
  EXPECT_GT(kept.share_of(1), kKept);
}

TEST(RobustRules, KeepsParallelBeamsOfTheSameHeight) {
  BoxRoom room;
  room.boxes = {{{0.85, -3.0, 1.2}, {1.15, 3.0, 1.6}}, {{-1.15, -3.0, 1.2}, {-0.85, 3.0, 1.6}}};
  const Kept kept = cut(room, {.tilt_deg = 60.0}, 7);  // in the sixth they turn into structure
  for (const int beam : {0, 1}) EXPECT_GT(kept.share_of(beam), kKept) << beam;
}

// A front is as high as most of it: a sign above it, in its plane, does not make it a wall.
TEST(RobustRules, RemovesACupboardBelowASign) {
  BoxRoom room;
  room.walls = {{-7.0, -1.1, -1.3}, {7.0, 1.1, 1.3}};
  room.boxes = {{{-0.6, -1.1, -1.3}, {1.0, -0.66, 0.68}}, {{0.2, -0.70, 0.75}, {0.4, -0.66, 1.1}}};
  EXPECT_LT(cut(room, {.tilt_deg = 60.0, .yaw_deg = 90.0}, 4).share_of(0), kRemoved);
}

// Their tops are out of view.
TEST(RobustRules, RemovesABoardThatStandsFreeAndKeepsAWallAsThin) {
  EXPECT_LT(cut(test::with({{2.0, -0.6, -1.0}, {2.05, 0.9, 0.9}}), {}).share_of(0), kRemoved);
  EXPECT_GT(cut(test::with({{2.0, -1.5, -1.0}, {2.05, 1.5, 0.9}}), {}).share_of(0), kKept);
}

// The pane goes on beside what is seen of its wall, down to a seat; or down to the floor, and then
// it is a wall and what stands before it a cupboard.
TEST(RobustRules, APaneInARecessDoesNotRejectItsWall) {
  const RoomBox front{{3.8, -3.0, -1.2}, {4.0, 1.7, 1.6}};
  BoxRoom room = test::with(front);
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
  room.boxes.push_back({{3.3, 1.7, -1.2}, {4.0, 3.0, -0.4}});
  EXPECT_GT(cut(room, {}).share_of(0), kKept);
}

// The last box is the sill alone: half of it is farther from both planes than their band.
TEST(RobustRules, KeepsTheSillOfAWindow) {
  BoxRoom room;
  room.walls = {{-4.0, -3.0, -1.2}, {4.0, 3.0, 1.6}};
  room.boxes = {{{3.75, -3.0, -1.2}, {4.0, -0.8, 1.6}},
                {{3.75, 0.8, -1.2}, {4.0, 3.0, 1.6}},
                {{3.75, -0.8, -1.2}, {4.0, 0.8, -0.701}},
                {{3.75, -0.8, 1.2}, {4.0, 0.8, 1.6}},
                {{3.75, -0.8, -0.701}, {4.0, 0.8, -0.7}}};
  EXPECT_GT(cut(room, {.tilt_deg = 10.0}, 6).share_of(4), kKept);
}

// The niche beside the front is seen as high as the front, or no higher than 2 m.
TEST(RobustRules, ATallFrontIsFurnitureOnlyBeforeAWallThatWasSeenAsHigh) {
  BoxRoom room;
  room.walls = {{-6.0, -4.0, -2.0}, {5.0, 4.0, 4.0}};
  room.boxes = {{{4.4, -4.0, -2.0}, {5.0, 1.5, 4.0}}};
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
  room.boxes.push_back({{3.9, 1.5, 0.0}, {5.0, 4.0, 4.0}});
  EXPECT_GT(cut(room, {}).share_of(0), kKept);
}

TEST(RobustRules, RemovesTheWallThatIsSeenBetweenShelves) {
  BoxRoom room;
  room.walls = {{-4.0, -3.0, -1.2}, {2.5, 3.0, 1.6}};
  room.boxes = {{{2.49, -0.5, -0.75}, {2.5, 0.5, 0.2}}};
  EXPECT_GT(cut(room, {}).share_of(0), kKept);
  for (const double z : {-1.15, -0.8, -0.45, -0.1, 0.25}) {
    room.boxes.push_back({{2.2, -0.5, z}, {2.5, 0.5, z + 0.04}});
  }
  EXPECT_LT(cut(room, {}).share_of(0), kMostlyRemoved);
}

// 3 cm behind the wall and with the tops out of view: one hangs over a pane, one closes its window.
TEST(RobustRules, RemovesBlindsAndKeepsTheWallBetweenThem) {
  BoxRoom room;
  room.walls = {{-3.0, -3.0, -1.2}, {3.25, 3.0, 1.6}};
  room.boxes = {{{3.03, -2.0, 0.0}, {3.05, -0.5, 1.6}}, {{3.03, 0.5, -0.4}, {3.05, 2.0, 1.6}},
                {{3.0, -3.0, -1.2}, {3.25, 3.0, -0.4}}, {{3.0, -3.0, -0.4}, {3.25, -2.0, 1.6}},
                {{3.0, -0.5, -0.4}, {3.25, 0.5, 1.6}},  {{3.0, 2.0, -0.4}, {3.25, 3.0, 1.6}}};
  const Kept kept = cut(room, {}, 4);
  for (const int blind : {0, 1}) EXPECT_LT(kept.share_of(blind), kMostlyRemoved) << blind;
  for (const int wall : {2, 3, 4, 5}) EXPECT_GT(kept.share_of(wall), 0.8) << wall;
}

// Farther apart than two cells, where not every cell of the back was taken for the wall.
TEST(RobustRules, RemovesTheBackBetweenShelvesThatAreFarApart) {
  BoxRoom room;
  room.walls = {{-4.0, -3.0, -1.2}, {2.5, 3.0, 1.6}};
  room.boxes = {{{2.49, -0.5, -0.75}, {2.5, 0.5, 0.2}}};
  for (const double z : {-1.15, -0.75, -0.35, 0.05, 0.45}) {
    room.boxes.push_back({{2.2, -0.5, z}, {2.5, 0.5, z + 0.04}});
  }
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
}

// Shelves along another wall end 0.2 m before it: they are square before what is seen past them.
TEST(RobustRules, KeepsTheWallThatIsSeenPastTheEndOfShelves) {
  BoxRoom room;
  room.walls = {{-4.0, -3.0, -1.2}, {2.5, 3.0, 1.6}};
  room.boxes = {{{2.49, 2.0, -1.2}, {2.5, 3.0, 1.6}}};
  for (const double z : {-1.15, -0.8, -0.45, -0.1, 0.25}) {
    room.boxes.push_back({{0.5, 2.1, z}, {2.3, 3.0, z + 0.04}});
  }
  EXPECT_GT(cut(room, {}).share_of(0), kKept);
}

// A border of voxels runs between a board and its wall, and through the noise of both. The second
// box is what of the wall is beside the board.
TEST(RobustRules, RemovesABoardAtABorderOfVoxelsAndKeepsTheWallBesideIt) {
  BoxRoom room;
  room.walls = {{-4.1, -3.1, -1.2}, {2.41, 3.1, 1.6}};
  room.boxes = {{{2.39, -0.7, -0.5}, {2.41, 0.7, 0.7}}, {{2.4099, -1.2, -0.5}, {2.41, -0.75, 0.7}}};
  const Kept kept = cut(room, {}, 6);
  EXPECT_LT(kept.share_of(0), kRemoved);
  EXPECT_GT(kept.share_of(1), kKept);
}

// The pane is seen above it; a cupboard hides what joins it to the rest of its wall.
TEST(RobustRules, KeepsTheWallBeneathAWindowInThePlaneOfALargerWall) {
  BoxRoom room;
  room.walls = {{-3.0, -3.0, -1.2}, {3.25, 3.0, 1.6}};
  room.boxes = {{{3.0, 1.2, -1.2}, {3.25, 3.0, 0.0}},
                {{2.2, 0.3, -1.2}, {3.25, 1.2, 1.6}},
                {{3.0, -3.0, -1.2}, {3.25, -2.0, 1.6}}};
  EXPECT_LT(cut(room, {}).share_of(0), kMostlyRemoved);
  room.boxes.back().high.y() = 0.3;
  EXPECT_GT(cut(room, {}).share_of(0), kKept);
}

// In a narrow corridor, where ghosts are dense: their voxels beside a wall have its shape, so that
// their number for the range tells; of the others, their number for the window.
TEST(RobustRules, BelievesHardlyAnyVoxelOfIsolatedGhosts) {
  constexpr double kHalfWidthM = 1.15;
  BoxRoom corridor;
  corridor.walls = {{-4.0, -kHalfWidthM, -1.2}, {4.0, kHalfWidthM, 1.6}};
  RobustCut robust({}, 2 * test::kMostPoints);
  const Kept kept =
      test::last_of(robust, corridor, {.ghosts = 0.01, .ghosts_beyond_m = 1.0, .firings = 2170}, 4);
  int behind = 0;
  int believed = 0;
  for (const robust::Surfel& surfel : robust.model().surfels) {
    if (std::abs(static_cast<double>(surfel.mean.y())) < kHalfWidthM + 0.15) continue;
    ++behind;
    believed += surfel.supported ? 1 : 0;
  }
  EXPECT_GT(behind, 100);
  EXPECT_LT(believed, behind / 100 + 1);
  EXPECT_GT(kept.share_of(test::kWalls), 0.985);
}

}  // namespace
}  // namespace convexcut
