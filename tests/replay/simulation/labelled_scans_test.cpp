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
double off_walls(const LabelledScan& s, std::size_t i, const Vec3& lidar) {
  const Vec3 p = lidar + Vec3f(s.scan.x[i], s.scan.y[i], s.scan.z[i]).cast<double>();
  double least = HUGE_VAL;
  const Vec3 high(8, 6, 3);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    least = std::min({least, std::abs(p[axis]), std::abs(p[axis] - high[axis])});
  }
  return least;
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
      ASSERT_LT(off_walls(s, i, {3, 2, 1.2}), 0.0015) << i;
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
      worst = std::max(worst, off_walls(s, i, {3, 2, 1.2}));
    }
  }
  EXPECT_EQ(revolutions, 3);
  // The clock of the IMU is known to 0.2 ms (it processes that long): 0.02° at 90 °/s.
  EXPECT_LT(worst, 0.006);
  EXPECT_GT(worst, 0.0);
}

}  // namespace
}  // namespace convexcut::simulation
