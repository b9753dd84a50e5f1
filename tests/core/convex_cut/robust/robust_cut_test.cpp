// SPDX-License-Identifier: Apache-2.0
//
// What RobustCut keeps and removes in rooms of boxes, one situation a test. How well it does in
// furnished rooms is measured by bench/accuracy; robust_scenes_test holds a part of that.
#include "core/convex_cut/robust/robust_cut.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/core/convex_cut/robust/room_cut.hpp"
#include "tests/support/effort.hpp"

namespace convexcut {
namespace {

using test::BoxRoom;
using test::cut;
using test::Kept;
using test::kMostPoints;
using test::LabelledCloud;
using test::revolution_in;
using test::with;

TEST(RobustCut, KeepsAnEmptyRoom) {
  for (const double tilt : {0.0, 30.0, 60.0}) {
    EXPECT_GT(cut({}, {.tilt_deg = tilt}).share_of(test::kWalls), 0.985) << tilt;
  }
}

TEST(RobustCut, RemovesATable) {
  const BoxRoom room = with({{1.0, 0.5, -0.5}, {2.2, 1.3, -0.45}});
  EXPECT_LT(cut(room, {}).share_of(0), 0.05);
}

TEST(RobustCut, RemovesACupboardThatIsLowerThanTheWallBehindIt) {
  const BoxRoom room = with({{3.5, -0.6, -1.2}, {4.0, 0.6, 0.1}});
  const Kept kept = cut(room, {});
  EXPECT_LT(kept.share_of(0), 0.1);  // but for the edges on floor and wall
  EXPECT_GT(kept.share_of(test::kWalls), 0.98);
}

TEST(RobustCut, RemovesABookcaseWhoseTopIsOutOfViewByTheWallBesideIt) {
  const BoxRoom room = with({{3.6, -1.0, -1.2}, {4.0, 1.0, 1.0}});
  RobustParameters believing;
  believing.furniture = false;
  EXPECT_GT(cut(room, {}, 1, believing).share_of(0), 0.9);
  EXPECT_LT(cut(room, {}).share_of(0), 0.1);
}

TEST(RobustCut, KeepsAPillarFromFloorToCeiling) {
  CONVEXCUT_LONG_TEST();
  const BoxRoom room = with({{1.6, 0.8, -1.2}, {2.0, 1.2, 1.6}});
  EXPECT_GT(cut(room, {.tilt_deg = 30.0}, 30).share_of(0), 0.9);
}

TEST(RobustCut, SeesInSeveralRevolutionsWhatEndsBelowTheCeiling) {
  CONVEXCUT_LONG_TEST();
  const BoxRoom room = with({{1.6, 0.8, -1.2}, {2.0, 1.2, 0.9}});  // higher than it looks at once
  EXPECT_LT(cut(room, {.tilt_deg = 30.0}, 30).share_of(0), 0.1);
}

// Its top is seen at first; then the lidar is level and decides by what it sees now.
TEST(RobustCut, RemembersWhatWasDecidedInEarlierRevolutions) {
  CONVEXCUT_LONG_TEST();
  const BoxRoom room = with({{1.6, 0.8, -1.2}, {2.0, 1.2, 0.5}});
  RobustParameters forgetful;
  forgetful.steady = false;
  const auto share_kept = [&](const RobustParameters& parameters) {
    RobustCut robust(parameters, kMostPoints);
    Kept kept = test::last_of(robust, room, {.tilt_deg = 30.0, .yaw_deg = 180.0}, 12);
    kept.cloud = revolution_in(room, {});
    kept.labels.resize(kept.cloud.cloud.size());
    EXPECT_EQ(robust.label(kept.cloud.cloud.view(), kept.labels, std::nullopt, 2), CutStatus::ok);
    return kept.share_of(0);
  };
  EXPECT_GT(share_kept(forgetful), 0.9);
  EXPECT_LT(share_kept({}), 0.2);
}

TEST(RobustCut, IsolatedGhostsCostNothing) {
  BoxRoom room = with({{1.0, 0.5, -0.5}, {2.2, 1.3, -0.45}});
  const Kept clean = cut(room, {});
  const Kept ghosts = cut(room, {.ghosts = 0.01});
  EXPECT_GT(ghosts.share_of(test::kWalls), clean.share_of(test::kWalls) - 0.003);
  EXPECT_LT(ghosts.share_of(0), clean.share_of(0) + 0.02);
  EXPECT_LT(ghosts.share_of(test::kGhost), 0.2);  // of those, many are on a surface by chance
}

TEST(RobustCut, RemovesAMirrorImage) {
  BoxRoom room;
  room.has_mirror = true;
  RobustParameters believing;
  believing.mirrors = false;
  EXPECT_GT(cut(room, {}, 1, believing).share_of(test::kGhost), 0.3);
  const Kept kept = cut(room, {});
  EXPECT_LT(kept.share_of(test::kGhost), 0.15);
  EXPECT_GT(kept.share_of(test::kWalls), 0.98);
}

TEST(RobustCut, CorrectsFiveDegreesOfGravity) {
  for (const double tilt : {0.0, 30.0}) {
    const double right = cut({}, {.tilt_deg = tilt}).share_of(test::kWalls);
    const double wrong = cut({}, {.tilt_deg = tilt, .gravity_deg = 5.0}).share_of(test::kWalls);
    EXPECT_GT(wrong, right - 0.003) << tilt;
  }
}

TEST(RobustCut, FollowsARigThatMoves) {
  const BoxRoom room = with({{1.0, 0.5, -0.5}, {2.2, 1.3, -0.45}});
  for (const bool told : {false, true}) {
    RobustCut robust({}, kMostPoints);
    Kept kept;
    for (int i = 0; i < 20; ++i) {
      const Vec3 step(0.08, -0.04, 0.0);
      const Vec3 position = Vec3(-1.0, 0.0, 0.0) + i * step;
      kept.cloud = revolution_in(
          room, {.position = position, .step = step, .seed = 1U + static_cast<unsigned>(i)});
      kept.labels.assign(kept.cloud.cloud.size(), Label::other);
      ASSERT_EQ(robust.label(kept.cloud.cloud.view(), kept.labels,
                             told ? std::optional(position) : std::nullopt),
                CutStatus::ok);
    }
    EXPECT_GT(kept.share_of(test::kWalls), 0.97) << told;
    EXPECT_LT(kept.share_of(0), 0.1) << told;
  }
}

TEST(RobustCut, StartsAnewInAnotherRoom) {
  RobustCut robust({}, kMostPoints);
  BoxRoom other;
  other.walls = {{-2.0, -9.0, -1.0}, {3.0, 5.0, 2.4}};
  Kept kept;
  for (const BoxRoom& room : {BoxRoom{}, BoxRoom{}, other}) {
    kept.cloud = revolution_in(room, {});
    kept.labels.assign(kept.cloud.cloud.size(), Label::other);
    ASSERT_EQ(robust.label(kept.cloud.cloud.view(), kept.labels), CutStatus::ok);
  }
  EXPECT_GT(kept.share_of(test::kWalls), 0.97);
}

TEST(RobustCut, LabelsDependOnTheCallsSinceForgettingAlone) {
  const BoxRoom room = with({{1.0, 0.5, -0.5}, {2.2, 1.3, -0.45}});
  RobustCut fresh({}, kMostPoints);
  RobustCut used({}, kMostPoints);
  const LabelledCloud before = revolution_in({}, {.tilt_deg = 20.0});
  std::vector<Label> expected(before.cloud.size());
  std::vector<Label> found(before.cloud.size());
  ASSERT_EQ(used.label(before.cloud.view(), found), CutStatus::ok);
  used.forget();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const LabelledCloud cloud = revolution_in(room, {.tilt_deg = 30.0, .seed = seed});
    ASSERT_EQ(fresh.label(cloud.cloud.view(), expected), CutStatus::ok);
    ASSERT_EQ(used.label(cloud.cloud.view(), found), CutStatus::ok);
    EXPECT_EQ(found, expected) << seed;
  }
}

TEST(RobustCut, AShorterWindowIsThatOfFewerRevolutions) {
  RobustCut reduced({.window = 30}, kMostPoints);
  RobustCut few({.window = 2}, kMostPoints);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const LabelledCloud cloud = revolution_in({}, {.tilt_deg = 30.0, .seed = seed});
    std::vector<Label> expected(cloud.cloud.size());
    std::vector<Label> found(cloud.cloud.size());
    ASSERT_EQ(few.label(cloud.cloud.view(), expected), CutStatus::ok);
    ASSERT_EQ(reduced.label(cloud.cloud.view(), found, std::nullopt, 2), CutStatus::ok);
    EXPECT_EQ(found, expected) << seed;
  }
}

TEST(RobustCut, RefusesWhatTheEngineRefuses) {
  RobustCut robust({}, 100);
  test::Random random(1);
  test::Cloud cloud = test::furnished_room(random, 100);
  std::vector<Label> labels(100, Label::structure);
  const std::vector<Label> untouched = labels;
  cloud.y[50] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(robust.label(cloud.view(), labels), CutStatus::coordinate_out_of_range);
  cloud.y[50] = 0.0F;
  cloud.add(1, 1, 1);
  std::vector<Label> more(101);
  EXPECT_EQ(robust.label(cloud.view(), more), CutStatus::too_many_points);
  cloud.z.pop_back();
  EXPECT_EQ(
      robust.label({{cloud.x.data(), 100}, {cloud.y.data(), 100}, {cloud.z.data(), 99}}, labels),
      CutStatus::size_mismatch);
  EXPECT_EQ(labels, untouched);
}

TEST(RobustCut, RefusesParametersOutOfRange) {
  EXPECT_THROW(RobustCut({.window = 0}, 100), std::invalid_argument);
  EXPECT_THROW(RobustCut({.window = kMaxRobustWindow + 1}, 100), std::invalid_argument);
  EXPECT_THROW(RobustCut({.band_m = 0.0F}, 100), std::invalid_argument);
  EXPECT_THROW(RobustCut({.band_m = std::numeric_limits<float>::quiet_NaN()}, 100),
               std::invalid_argument);
}

TEST(RobustCut, TakesAnyCloud) {
  for (const test::Distribution& distribution : test::distributions()) {
    RobustCut robust({.window = 3}, 10'000);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      test::Random random(seed);
      const test::Cloud cloud = distribution.make(random);
      std::vector<Label> labels(cloud.size());
      EXPECT_EQ(robust.label(cloud.view(), labels), CutStatus::ok) << distribution.name;
    }
  }
}

}  // namespace
}  // namespace convexcut
