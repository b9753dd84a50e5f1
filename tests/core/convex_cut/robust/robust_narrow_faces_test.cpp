// SPDX-License-Identifier: Apache-2.0
//
// One rule of RobustCut on pillars, piers, stands and people a test: what is narrow. How often they
// are right in furnished rooms is measured by bench/accuracy.
#include <algorithm>
#include <cmath>
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

TEST(RobustNarrowFaces, KeepsAPillarWhoseFootIsHiddenAndRemovesALamp) {
  BoxRoom room;
  room.walls = {{-4.0, -3.0, -1.2}, {4.0, 3.0, 3.0}};
  room.boxes = {{{-3.2, -0.3, -1.2}, {-2.6, 0.3, 3.0}},
                {{-2.2, -1.0, -1.2}, {-1.6, 1.0, 0.45}},
                {{-3.0, 0.8, 1.0}, {-2.5, 1.3, 1.6}}};
  // A plane through the pillar's face and the lamp before it is neither's, whatever the noise.
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Kept kept = cut(room, {.tilt_deg = 30.0, .seed = 7 * seed}, 6);
    EXPECT_GT(kept.share_of(0), 0.8) << seed;
    EXPECT_LT(kept.share_of(2), kRemoved) << seed;
  }
}

// A pier over a cupboard, of which 0.6 m are in view, beside openings to what is behind.
TEST(RobustNarrowFaces, KeepsANarrowFaceWithinAWiderWallAndRemovesItAlone) {
  BoxRoom room;
  room.walls = {{-4.0, -3.0, -1.2}, {5.0, 3.0, 1.6}};
  room.boxes = {{{3.0, 1.0, 0.0}, {3.2, 1.5, 1.6}}, {{2.5, 1.0, -1.2}, {3.2, 1.5, 0.0}}};
  EXPECT_LT(cut(room, {}).share_of(0), kRemoved);
  room.boxes.push_back({{3.0, -3.0, -1.2}, {3.2, -0.2, 1.6}});
  EXPECT_GT(cut(room, {}).share_of(0), kKept);
}

// A pier whose foot is hidden and whose top is out of view: 0.9 m of it are in view, in four cells.
// One that is set back in the middle may be a person.
TEST(RobustNarrowFaces, KeepsAFlatNarrowFaceThatIsSeenInFourCells) {
  for (const double set_back_m : {0.0, 0.03}) {
    BoxRoom room;
    room.boxes = {{{2.7, -0.25, -0.4}, {3.2, 0.0, 1.6}},
                  {{2.7 + set_back_m, 0.0, -0.4}, {3.2, 0.25, 1.6}},
                  {{2.3, -0.25, -1.2}, {3.2, 0.25, -0.4}}};
    const double kept = cut(room, {.noise_m = 0.01}, 4).share_of(0);
    if (set_back_m > 0.0) {
      EXPECT_LT(kept, kRemoved);
    } else {
      EXPECT_GT(kept, kKept);
    }
  }
}

// Its bands are set back in turn, as a person's body is; and a wide flat part of the same plane is
// in another place.
TEST(RobustNarrowFaces, ANarrowFaceIsJudgedByItsOwnSpread) {
  for (const double set_back_m : {0.0, 0.05, 0.08}) {
    BoxRoom room;
    room.boxes = {{{2.1, -2.7, -1.2}, {2.4, -2.2, 1.6}}};
    for (int i = 0; i < 9; ++i) {
      const double z = -1.2 + 0.25 * i;
      room.boxes.push_back({{2.1 + set_back_m * (i % 2), 0.5, z}, {2.4, 1.0, z + 0.25}});
    }
    Kept kept = cut(room, {}, 4);
    for (int& box : kept.cloud.box) box = std::min(box, 1);
    if (set_back_m > 0.0) {
      EXPECT_LT(kept.share_of(1), kMostlyRemoved) << set_back_m;
    } else {
      EXPECT_GT(kept.share_of(1), kKept);
    }
  }
}

// Of a round column, 0.6 m thick: how much is kept. Every other band of 0.3 m is aside.
double kept_of_column(double top_m, double aside_m, const RobustParameters& parameters = {}) {
  constexpr double kRadiusM = 0.3;
  BoxRoom room;
  for (int i = 0; - 1.2 + 0.3 * i < top_m; ++i) {
    const double low = -1.2 + 0.3 * i;
    const double y = 0.7 + aside_m * (i % 2);
    for (const double half : {0.08, 0.16, 0.22, 0.26, 0.29}) {
      const double across = std::sqrt(kRadiusM * kRadiusM - half * half);
      room.boxes.push_back(
          {{2.0 - half, y - across, low}, {2.0 + half, y + across, std::min(low + 0.3, top_m)}});
    }
  }
  Kept kept = cut(room, {.noise_m = 0.01}, 4, parameters);
  for (int& box : kept.cloud.box) box = std::min(box, 0);
  return kept.share_of(0);
}

TEST(RobustNarrowFaces, KeepsAColumnWhoseFootprintIsTheSameUpToTheEndOfTheView) {
  EXPECT_GT(kept_of_column(1.6, 0.0), kKept);
  EXPECT_LT(kept_of_column(1.6, 0.0, {.pillars = false}), 0.8);  // planes alone
  EXPECT_LT(kept_of_column(1.6, 0.08), kMostlyRemoved);
  EXPECT_LT(kept_of_column(0.15, 0.0), kMostlyRemoved);
}

// A round pillar that is half in a wall, which ends rays closer behind its middle than its own
// sides are. One that wall is seen over may be a cupboard, and one whose other side is hidden the
// end of a row of them.
TEST(RobustNarrowFaces, KeepsAPillarOnAWallThatIsSeenOnBothSidesOfIt) {
  const auto kept = [](double top_m, bool hidden) {
    constexpr double kRadiusM = 0.3;
    BoxRoom room;
    room.walls = {{-4.0, -3.0, -1.2}, {3.0, 3.0, 1.6}};
    for (const double half : {0.08, 0.16, 0.22, 0.26, 0.29}) {
      const double across = std::sqrt(kRadiusM * kRadiusM - half * half);
      room.boxes.push_back({{2.9 - half, 0.1 - across, -1.2}, {3.0, 0.1 + across, top_m}});
    }
    const int pillar = static_cast<int>(room.boxes.size());
    if (hidden) room.boxes.push_back({{1.6, 0.25, -1.2}, {1.9, 0.9, 1.6}});
    Kept of = cut(room, {}, 4);
    for (int& box : of.cloud.box) box = box < pillar ? std::min(box, 0) : test::kWalls;
    return of.share_of(0);
  };
  EXPECT_GT(kept(1.6, false), kKept);
  EXPECT_LT(kept(-0.1, false), kRemoved);
  EXPECT_LT(kept(1.6, true), kRemoved);
}

// A stand of a fair: its back is before the wall, its sides come forward. One that is as long and
// comes out of the wall is a wall.
TEST(RobustNarrowFaces, RemovesTheSidesOfAStand) {
  BoxRoom hall;
  hall.walls = {{-4.0, -5.0, -1.2}, {6.0, 5.0, 6.0}};
  hall.boxes = {{{5.3, -1.6, -1.2}, {5.35, 1.6, 1.3}},
                {{3.6, -1.65, -1.2}, {5.3, -1.6, 1.3}},
                {{3.6, 1.6, -1.2}, {5.3, 1.65, 1.3}}};
  const Kept stand = cut(hall, {});
  for (const int box : {0, 1, 2}) EXPECT_LT(stand.share_of(box), kMostlyRemoved) << box;
  hall.boxes = {{{4.3, 1.6, -1.2}, {6.0, 1.65, 1.3}}};
  EXPECT_GT(cut(hall, {}).share_of(0), kKept);
}

// As wide as a pillar may be, but a pillar has a second face or a round one.
TEST(RobustNarrowFaces, ABoardOfAPillarsWidthIsNone) {
  EXPECT_LT(cut(test::with({{2.0, -0.45, -1.0}, {2.05, 0.45, 0.9}}), {}).share_of(0), kRemoved);
}

// One face is set back in its middle, as a person's may be; the one that meets it is flat, or set
// back as well.
TEST(RobustNarrowFaces, AFlatFaceOfAPillarSpeaksForTheOneThatMeetsIt) {
  for (const double set_back_m : {0.0, 0.03}) {
    BoxRoom room;
    room.boxes = {{{1.6, 1.0, -1.2}, {1.8, 1.2, 0.9}},
                  {{1.63, 1.2, -1.2}, {2.0, 1.4, 0.9}},
                  {{1.8, 1.0 + set_back_m, -1.2}, {2.0, 1.2, 0.9}}};
    Kept kept = cut(room, {.noise_m = 0.01}, 4);
    for (int& box : kept.cloud.box) box = std::min(box, 0);
    if (set_back_m > 0.0) {
      EXPECT_LT(kept.share_of(0), kRemoved);
    } else {
      EXPECT_GT(kept.share_of(0), kKept);
    }
  }
}

}  // namespace
}  // namespace convexcut
