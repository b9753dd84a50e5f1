// SPDX-License-Identifier: Apache-2.0
//
// The geometry of a turning stage. Does not prove that a real stage's axis goes through the lidar's
// origin.
#include "core/scan/stage.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/core/scan/rotation.hpp"

namespace convexcut {
namespace {

using test::rpy;

Radians degrees(double value) { return Degrees{value}.to_radians(); }

void expect_same(const Quaternion& a, const Quaternion& b) {
  EXPECT_NEAR(a.angularDistance(b), 0.0, 1e-9);
}

TEST(Stage, TurnsAsTheAnglesOfAMountDo) {
  expect_same(stage_rotation(StageAxis::rotation, degrees(30)), rpy(0, 0, 30));
  expect_same(stage_rotation(StageAxis::tilt, degrees(30)), rpy(0, 30, 0));
  expect_same(stage_rotation(StageAxis::rotation, degrees(725)), rpy(0, 0, 5));
  // Tilted down, what is ahead lies below.
  EXPECT_LT((stage_rotation(StageAxis::tilt, degrees(10)) * Vec3::UnitX()).z(), 0.0);
}

TEST(Heading, IsTheYawOfRollPitchYaw) {
  for (const double yaw : {-179.0, -90.0, -1.0, 0.0, 45.0, 180.0}) {
    EXPECT_NEAR(to_degrees(heading(rpy(20, -35, yaw))).value, yaw, 1e-9) << yaw;
  }
}

TEST(Heading, OfAVerticalXAxisIsTakenFromY) {
  for (const double pitch : {90.0, -90.0}) {
    EXPECT_NEAR(to_degrees(heading(rpy(0, pitch, 25))).value, 25.0, 1e-6) << pitch;
  }
}

TEST(WithHeading, KeepsRollAndPitchAndTakesTheStagesYaw) {
  for (const double yaw : {-170.0, -20.0, 0.0, 100.0}) {
    for (const double angle : {-400.0, -90.0, 0.0, 33.0, 180.0}) {
      const Quaternion stage = stage_rotation(StageAxis::rotation, degrees(angle));
      expect_same(with_heading(rpy(12, -7, yaw), stage), rpy(12, -7, angle));
    }
  }
}

TEST(WithHeading, LeavesTheVerticalWhereItIsWhateverTheOrientation) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    Quaternion q(normal(random), normal(random), normal(random), normal(random));
    q.normalize();
    const Quaternion stage = stage_rotation(StageAxis::rotation, {normal(random)});
    const Quaternion turned = with_heading(q, stage);
    EXPECT_NEAR(turned.norm(), 1.0, 1e-12);
    // Seen from the lidar, up is where it was: roll and pitch are untouched.
    EXPECT_LT((turned.conjugate() * Vec3::UnitZ() - q.conjugate() * Vec3::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(std::remainder(heading(turned).value - heading(stage).value, 2 * 3.14159265358979),
                0.0, 1e-9);
  }
}

}  // namespace
}  // namespace convexcut
