// SPDX-License-Identifier: Apache-2.0
//
// Labels that do not wait until their revolution is learnt from. What that costs in furnished rooms
// is measured by bench/accuracy (ablation), the time that it gains by bench/convex_cut.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/robust_cut.hpp"
#include "tests/core/convex_cut/robust/room_cut.hpp"

namespace convexcut {
namespace {

using test::BoxRoom;
using test::Kept;
using test::kMostPoints;
using test::LabelledCloud;
using test::revolution_in;
using test::with;

using Learning = RobustCut::Learning;

const BoxRoom& room_with_a_table() {
  static const BoxRoom room = with({{1.0, 0.5, -0.5}, {2.2, 1.3, -0.45}});
  return room;
}

[[nodiscard]] std::vector<Label> labels_of(RobustCut& robust, const LabelledCloud& cloud) {
  std::vector<Label> labels(cloud.cloud.size());
  EXPECT_EQ(robust.label(cloud.cloud.view(), labels), CutStatus::ok);
  return labels;
}

[[nodiscard]] std::vector<Label> labels_at_once(RobustCut& robust, const LabelledCloud& cloud) {
  std::vector<Label> labels(cloud.cloud.size());
  EXPECT_EQ(robust.label_at_once(cloud.cloud.view(), labels), CutStatus::ok);
  return labels;
}

TEST(RobustCutAtOnce, TheFirstRevolutionIsLearntFromBeforeItIsLabelled) {
  const LabelledCloud cloud = revolution_in(room_with_a_table(), {});
  RobustCut waiting({}, kMostPoints);
  RobustCut at_once({}, kMostPoints);
  EXPECT_EQ(labels_at_once(at_once, cloud), labels_of(waiting, cloud));
  EXPECT_FALSE(at_once.learn());
}

TEST(RobustCutAtOnce, KeepsTheRoomAndRemovesTheTable) {
  RobustCut robust({}, kMostPoints);
  Kept kept;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    kept.cloud = revolution_in(room_with_a_table(), {.seed = seed});
    kept.labels = labels_at_once(robust, kept.cloud);
    EXPECT_EQ(robust.learn(), seed > 1) << seed;
  }
  EXPECT_GT(kept.share_of(test::kWalls), 0.98);
  EXPECT_LT(kept.share_of(0), 0.05);
}

// Verdicts are of the labels that were given, so they are left out here.
TEST(RobustCutAtOnce, WhatIsLearntAfterLabellingIsWhatWouldHaveBeenLearntBefore) {
  RobustCut waiting({.steady = false}, kMostPoints);
  RobustCut at_once({.steady = false}, kMostPoints);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const LabelledCloud cloud = revolution_in(
        room_with_a_table(),
        {.tilt_deg = 30.0, .yaw_deg = 12.0 * static_cast<double>(seed), .seed = seed});
    const std::vector<Label> expected = labels_of(waiting, cloud);
    if (seed == 5) {
      EXPECT_EQ(labels_of(at_once, cloud), expected);
    } else {
      static_cast<void>(labels_at_once(at_once, cloud));
      at_once.learn();
    }
  }
}

// Poses are left as they are expected, since they are laid on the planes that are known.
TEST(RobustCutAtOnce, RevolutionsThatAreLearntFromLaterAreRemembered) {
  const RobustParameters parameters{.window = 4, .align = false, .steady = false};
  RobustCut waiting(parameters, kMostPoints);
  RobustCut at_once(parameters, kMostPoints);
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const LabelledCloud cloud = revolution_in(
        room_with_a_table(),
        {.tilt_deg = 30.0, .yaw_deg = 12.0 * static_cast<double>(seed), .seed = seed});
    const std::vector<Label> expected = labels_of(waiting, cloud);
    if (seed % 4 == 0) {
      EXPECT_EQ(labels_of(at_once, cloud), expected) << seed;
      continue;
    }
    const std::size_t known = at_once.model().surfels.size();
    static_cast<void>(labels_at_once(at_once, cloud));
    EXPECT_FALSE(at_once.learn(Learning::later));
    EXPECT_TRUE(seed == 1 || at_once.model().surfels.size() == known) << seed;
  }
}

TEST(RobustCutAtOnce, ARevolutionIsLearntFromOnce) {
  RobustCut robust({}, kMostPoints);
  const LabelledCloud cloud = revolution_in({}, {});
  EXPECT_FALSE(robust.learn());
  static_cast<void>(labels_of(robust, cloud));
  EXPECT_FALSE(robust.learn());
  static_cast<void>(labels_at_once(robust, cloud));
  EXPECT_TRUE(robust.learn());
  EXPECT_FALSE(robust.learn());
  static_cast<void>(labels_at_once(robust, cloud));
  robust.forget();
  EXPECT_FALSE(robust.learn());
}

// A tilted lidar that has turned sees of floor, walls and ceiling what it had not seen.
TEST(RobustCutAtOnce, WallsGoOnWhereNothingIsKnown) {
  RobustCut robust({}, kMostPoints);
  static_cast<void>(labels_of(robust, revolution_in({}, {.tilt_deg = 60.0})));
  Kept kept;
  kept.cloud = revolution_in({}, {.tilt_deg = 60.0, .yaw_deg = 20.0, .seed = 2});
  kept.labels = labels_at_once(robust, kept.cloud);
  EXPECT_GT(kept.share_of(test::kWalls), 0.97);
}

TEST(RobustCutAtOnce, StartsAnewInAnotherRoom) {
  RobustCut robust({}, kMostPoints);
  BoxRoom other;
  other.walls = {{-2.0, -9.0, -1.0}, {3.0, 5.0, 2.4}};
  Kept kept;
  for (const BoxRoom& room : {BoxRoom{}, BoxRoom{}, other}) {
    kept.cloud = revolution_in(room, {});
    kept.labels = labels_at_once(robust, kept.cloud);
    robust.learn(Learning::later);
  }
  EXPECT_GT(kept.share_of(test::kWalls), 0.97);
}

TEST(RobustCutAtOnce, TakesAnyCloudHoweverItIsLearntFrom) {
  for (const test::Distribution& distribution : test::distributions()) {
    RobustCut robust({.window = 3}, 10'000);
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      test::Random random(seed);
      const test::Cloud cloud = distribution.make(random);
      std::vector<Label> labels(cloud.size());
      EXPECT_EQ(robust.label_at_once(cloud.view(), labels), CutStatus::ok) << distribution.name;
      if (seed % 4 != 0) robust.learn(seed % 2 == 0 ? Learning::now : Learning::later);
    }
  }
}

}  // namespace
}  // namespace convexcut
