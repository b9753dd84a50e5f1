// SPDX-License-Identifier: Apache-2.0
//
// Where revolutions are laid. How far that is off in furnished rooms, and what it costs, only a
// simulation tells.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/robust_cut.hpp"
#include "tests/core/convex_cut/robust/room_cut.hpp"

namespace convexcut {
namespace {

using test::BoxRoom;
using test::kRemoved;

// From where it began, of all places in the window that the rig is taken to have been in.
[[nodiscard]] float farthest_of_rig(const RobustCut& robust, const Vec3f& direction) {
  float farthest = 0.0F;
  for (const robust::Surfel& surfel : robust.model().surfels) {
    farthest = std::max(farthest, surfel.origin.dot(direction));
  }
  return farthest;
}

TEST(RobustPose, TheLatticeLiesAlongTheWalls) {
  test::LabelledCloud seen = test::revolution_in({}, {});
  const Eigen::AngleAxisf turn(0.3F, Vec3f::UnitZ());
  for (std::size_t i = 0; i < seen.cloud.size(); ++i) {
    const Vec3f p = turn * Vec3f(seen.cloud.x[i], seen.cloud.y[i], seen.cloud.z[i]);
    seen.cloud.x[i] = p.x();
    seen.cloud.y[i] = p.y();
  }
  std::vector<Label> labels(seen.cloud.size());
  RobustCut robust({}, test::kMostPoints);
  ASSERT_EQ(robust.label(seen.cloud.view(), labels), CutStatus::ok);
  int walls = 0;
  for (const robust::Plane& plane : robust.model().planes) {
    if (!plane.vertical || plane.surfels < 50) continue;
    ++walls;
    EXPECT_LT(std::min(std::abs(plane.normal.x()), std::abs(plane.normal.y())), 0.02F);
  }
  EXPECT_EQ(walls, 4);
}

// A corridor whose ends are out of view from the fourth revolution on: the rig may stand by then.
TEST(RobustPose, AMotionThatNoPlaneHoldsDiesOut) {
  constexpr double kStepM = 0.06;
  BoxRoom corridor;
  corridor.walls = {{-4.0, -1.2, -1.2}, {4.0, 1.2, 1.6}};
  RobustCut robust({}, test::kMostPoints);
  for (int i = 0; i < 12; ++i) {
    const bool moves = i < 3;
    if (!moves) corridor.walls = {{-60.0, -1.2, -1.2}, {60.0, 1.2, 1.6}};
    const test::Sight sight{.position = {moves ? kStepM * i : 2 * kStepM, 0.0, 0.0},
                            .step = {moves ? kStepM : 0.0, 0.0, 0.0},
                            .seed = static_cast<std::uint64_t>(i)};
    (void)test::last_of(robust, corridor, sight, 1);
  }
  const float farthest = farthest_of_rig(robust, Vec3f::UnitX());
  EXPECT_GT(farthest, 1.5F * static_cast<float>(kStepM));
  EXPECT_LT(farthest, 8.0F * static_cast<float>(kStepM));
}

// The walls across the motion are too far to be seen; a cupboard that stands before none is.
TEST(RobustPose, FurnitureHoldsThePose) {
  constexpr double kStepM = 0.05;
  constexpr int kRevolutions = 6;
  BoxRoom corridor;
  corridor.walls = {{-60.0, -2.0, -1.2}, {60.0, 2.0, 1.6}};
  corridor.boxes = {{{2.5, -0.8, -1.2}, {2.9, 0.8, 0.2}}};
  RobustCut robust({}, test::kMostPoints);
  for (int i = 0; i < kRevolutions; ++i) {
    const test::Sight sight{.position = {kStepM * i, 0.0, 0.0},
                            .step = {kStepM, 0.0, 0.0},
                            .seed = static_cast<std::uint64_t>(i)};
    EXPECT_LT(test::last_of(robust, corridor, sight, 1).share_of(0), kRemoved);
  }
  const float farthest = farthest_of_rig(robust, Vec3f::UnitX());
  EXPECT_NEAR(farthest, kStepM * (kRevolutions - 1), 0.02);
}

// The lidar stands, and from one revolution to the next more or less of the boards is in view.
TEST(RobustPose, BoardsDoNotDrawThePose) {
  BoxRoom room;
  room.boxes = {{{3.96, -3.0, -0.4}, {4.0, 0.0, 1.1}},
                {{-4.0, 0.0, -0.4}, {-3.97, 2.4, 0.9}},
                {{-2.0, -3.0, -0.4}, {2.0, -2.97, 0.8}}};
  for (const std::uint64_t seed : {1U, 101U, 201U}) {
    RobustCut robust({}, test::kMostPoints);
    (void)test::last_of(robust, room, {.tilt_deg = 30.0, .noise_m = 0.01, .seed = seed}, 28);
    for (const Vec3f& axis : {Vec3f(Vec3f::UnitX()), Vec3f(Vec3f::UnitY())}) {
      EXPECT_LT(farthest_of_rig(robust, axis), 0.005F) << seed;
      EXPECT_LT(farthest_of_rig(robust, -axis), 0.005F) << seed;
    }
  }
}

}  // namespace
}  // namespace convexcut
