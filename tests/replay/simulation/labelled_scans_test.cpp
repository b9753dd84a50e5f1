// SPDX-License-Identifier: Apache-2.0
//
// Scans in memory: the drivers, the cutter and the levelling make of the simulated bytes what was
// simulated. Not proved: that a real sensor sees like this one.
#include "replay/simulation/labelled_scans.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/replay/simulation/scenes.hpp"

namespace convexcut::simulation {
namespace {

using namespace std::chrono_literals;
using test::empty_room;

LabelledScanOptions options(const Scene& scene, Duration length) {
  LabelledScanOptions options;
  options.simulation.length = length;
  options.simulation.rig = planned_rig(scene, false);
  return options;
}

// The distance of a point of the level frame from the room's nearest side.
double off_walls(const LabelledScan& s, std::size_t i) {
  const Vec3 p = Vec3(3, 2, 1.2) + Vec3f(s.scan.x[i], s.scan.y[i], s.scan.z[i]).cast<double>();
  return std::min(p.cwiseAbs().minCoeff(), (p - test::kRoom).cwiseAbs().minCoeff());
}

TEST(LabelledScans, WholeRevolutionsHaveTheTruthOfEveryPoint) {
  const Scene scene = empty_room();
  LabelledScanOptions o = options(scene, 350ms);
  o.levelling = Levelling::truth;
  o.simulation.lidar.noise_m = 0.0;
  o.simulation.lidar.divergence = {0.0};
  o.simulation.rig.tilt = Degrees{30};
  o.simulation.rig.rotation_per_second = Degrees{60};
  LabelledScans scans(scene, o);
  LabelledScan s;
  int revolutions = 0;
  while (scans.next(s)) {
    ++revolutions;
    ASSERT_EQ(s.label.size(), s.scan.size());
    EXPECT_GT(s.scan.size(), 65'000U);
    EXPECT_GT(s.scan.coverage, 0.999);
    for (std::size_t i = 0; i < s.scan.size(); ++i) {
      ASSERT_EQ(s.label[i], SurfaceLabel::structure);
      ASSERT_NEAR(s.range_m[i], s.true_range_m[i], 0.0011);
      ASSERT_LT(off_walls(s, i), 0.0015) << i;
    }
  }
  EXPECT_EQ(revolutions, 3);
}

TEST(LabelledScans, TheImuLevelsAsWellAsItsErrorsLetIt) {
  const Scene scene = empty_room();
  LabelledScanOptions o = options(scene, 350ms);
  o.simulation.lidar.noise_m = 0.0;
  o.simulation.lidar.divergence = {0.0};
  o.simulation.rig.tilt = Degrees{30};
  o.simulation.rig.rotation_per_second = Degrees{90};
  o.simulation.imu_errors = kIdealImu;
  LabelledScans scans(scene, o);
  LabelledScan s;
  double worst = 0;
  int revolutions = 0;
  while (scans.next(s)) {
    ++revolutions;
    for (std::size_t i = 0; i < s.scan.size(); ++i) {
      worst = std::max(worst, off_walls(s, i));
    }
  }
  EXPECT_EQ(revolutions, 3);
  // The clock of the IMU is known to 0.2 ms (it processes that long): 0.02° at 90 °/s.
  EXPECT_LT(worst, 0.006);
  EXPECT_GT(worst, 0.0);
}

TEST(LabelledScans, AGivenErrorOfGravityTiltsTheRoom) {
  const Scene scene = empty_room();
  LabelledScanOptions o = options(scene, 150ms);
  o.levelling = Levelling::truth;
  o.simulation.imu_errors.gravity = Degrees{5};
  LabelledScans scans(scene, o);
  LabelledScan s;
  ASSERT_TRUE(scans.next(s));
  double farthest = 0;
  for (std::size_t i = 0; i < s.scan.size(); ++i) farthest = std::max(farthest, off_walls(s, i));
  // 5° over some metres; the noise alone stays below 0.1 m.
  EXPECT_GT(farthest, 0.2);
  EXPECT_LT(farthest, 0.6);
}

TEST(LabelledScans, TheTruthFollowsItsPointsThroughLossAndDisorder) {
  const Scene scene = Scene::named("office");
  LabelledScanOptions o = options(scene, 350ms);
  o.simulation.lidar.dual = true;
  o.simulation.lidar.ghosts = 0.01;
  o.simulation.link.loss = 0.05;
  o.simulation.link.duplicate = 0.05;
  o.simulation.link.reorder = 0.05;
  o.simulation.link.pps = PpsState::absent;
  o.simulation.lidar.clock.fast_by_ppm = 50.0;
  o.simulation.rig.sway = Degrees{2};
  LabelledScans scans(scene, o);
  LabelledScan s;
  std::size_t points = 0;
  std::size_t ghosts = 0;
  while (scans.next(s)) {  // throws when a point is not where the truth has it
    points += s.scan.size();
    for (std::size_t i = 0; i < s.scan.size(); ++i) {
      ASSERT_LT(s.range_m[i], 30.0F);
      if ((s.flags[i] & kIsolatedGhost) != 0) {
        ++ghosts;
      } else {
        ASSERT_NEAR(s.range_m[i], s.true_range_m[i], 0.13);
      }
    }
  }
  EXPECT_GT(points, 180'000U);
  EXPECT_NEAR(static_cast<double>(ghosts) / static_cast<double>(points), 0.01, 0.004);
}

TEST(LabelledScans, AMovingRigIsWhereItSaysItIs) {
  const Scene scene = empty_room();
  LabelledScanOptions o = options(scene, 350ms);
  o.levelling = Levelling::truth;
  o.simulation.lidar.noise_m = 0.0;
  o.simulation.lidar.divergence = {0.0};
  o.simulation.rig.path = RigPath({{3, 2, 1.2}, {5, 4, 1.2}, {6, 2, 1.3}}, 1.0, PathEnd::back);
  LabelledScans scans(scene, o);
  LabelledScan s;
  std::size_t points = 0;
  while (scans.next(s)) {
    for (std::size_t i = 0; i < s.scan.size(); i += 7) {
      const Pose pose = scans.pose_at(s.scan.stamp + Duration{s.scan.time_ns[i]});
      const Vec3 p =
          pose.position_world + Vec3f(s.scan.x[i], s.scan.y[i], s.scan.z[i]).cast<double>();
      const double off = std::min(p.cwiseAbs().minCoeff(), (p - test::kRoom).cwiseAbs().minCoeff());
      ASSERT_LT(off, 0.0015) << i;
      ++points;
    }
  }
  EXPECT_GT(points, 25'000U);
}

}  // namespace
}  // namespace convexcut::simulation
