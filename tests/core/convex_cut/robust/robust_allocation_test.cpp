// SPDX-License-Identifier: Apache-2.0
//
// RobustCut allocates nothing once it is made. Does not see allocations that go to malloc directly;
// its sources have none.
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/robust_cut.hpp"
#include "tests/core/convex_cut/robust/labelled_room.hpp"
#include "tests/support/allocations.hpp"

namespace convexcut {
namespace {

TEST(RobustCutAllocation, LabelAllocatesNothing) {
  RobustCut robust({.window = 4}, 40'000);
  test::BoxRoom room;
  room.boxes = {{{1.0, 0.5, -0.5}, {2.2, 1.3, -0.45}}, {{3.6, -1.0, -1.2}, {4.0, 1.0, 0.6}}};
  room.has_mirror = true;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const test::LabelledCloud cloud = test::revolution_in(
        room, {.tilt_deg = 30.0, .yaw_deg = 12.0 * static_cast<double>(seed), .seed = seed});
    std::vector<Label> labels(cloud.cloud.size());
    const std::uint64_t before = test::allocations();
    const CutStatus status = robust.label(cloud.cloud.view(), labels);
    EXPECT_EQ(test::allocations() - before, 0U) << seed;
    EXPECT_EQ(status, CutStatus::ok);
  }
}

TEST(RobustCutAllocation, LabellingAtOnceAndLearningAllocateNothing) {
  RobustCut robust({.window = 4}, 40'000);
  test::BoxRoom room;
  room.boxes = {{{1.0, 0.5, -0.5}, {2.2, 1.3, -0.45}}, {{3.6, -1.0, -1.2}, {4.0, 1.0, 0.6}}};
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const test::LabelledCloud cloud = test::revolution_in(
        room, {.tilt_deg = 30.0, .yaw_deg = 12.0 * static_cast<double>(seed), .seed = seed});
    std::vector<Label> labels(cloud.cloud.size());
    const std::uint64_t before = test::allocations();
    const CutStatus status = robust.label_at_once(cloud.cloud.view(), labels);
    robust.learn(seed % 2 == 0 ? RobustCut::Learning::now : RobustCut::Learning::later);
    EXPECT_EQ(test::allocations() - before, 0U) << seed;
    EXPECT_EQ(status, CutStatus::ok);
  }
}

TEST(RobustCutAllocation, LabelAllocatesNothingForAnyCloud) {
  for (const test::Distribution& distribution : test::distributions()) {
    RobustCut robust({.window = 2}, 10'000);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      test::Random random(seed);
      const test::Cloud cloud = distribution.make(random);
      std::vector<Label> labels(cloud.size());
      const std::uint64_t before = test::allocations();
      static_cast<void>(robust.label(cloud.view(), labels));
      EXPECT_EQ(test::allocations() - before, 0U) << distribution.name;
    }
  }
}

}  // namespace
}  // namespace convexcut
