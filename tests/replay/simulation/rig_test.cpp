// SPDX-License-Identifier: Apache-2.0
//
// The truth of the rig: motion, what its IMU makes of it, and the exact arithmetic below. Not
// proved: that hands, stages and MTi-30s move and err like these.
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "replay/simulation/random.hpp"
#include "replay/simulation/rig/rig_imu.hpp"
#include "replay/simulation/rig/rig_motion.hpp"
#include "replay/simulation/sin_cos.hpp"

namespace convexcut::simulation {
namespace {

using namespace std::chrono_literals;

RigOptions everything() {
  RigOptions rig;
  rig.tilt = Degrees{30};
  rig.tilt_swing = Degrees{10};
  rig.rotation_per_second = Degrees{40};
  rig.sway = Degrees{2};
  rig.sway_m = 0.01;
  rig.path = RigPath({{0, 0, 1}, {3, 0, 1}, {3, 2, 1.2}}, 0.8, PathEnd::back);
  return rig;
}

double seconds(Duration d) { return std::chrono::duration<double>(d).count(); }

TEST(RigMotion, ImuMeasuresTheDerivativesOfThePose) {
  const RigMotion motion(everything(), 5);
  constexpr Duration kStep = 100us;
  const double h = seconds(kStep);
  for (Duration t = 50ms; t < 9s; t += 173ms) {
    const Pose before = motion.pose_at(t - kStep);
    const Pose now = motion.pose_at(t);
    const Pose after = motion.pose_at(t + kStep);
    const Quaternion change = before.q_world_from_lidar.conjugate() * after.q_world_from_lidar;
    const Vec3 rate = change.vec() / (change.w() * h);
    const RigState state = motion.state(t);
    ASSERT_TRUE(rate.isApprox(state.angular_velocity_rad_s, 1e-5)) << seconds(t);
    const Vec3 acceleration =
        (after.position_world - 2.0 * now.position_world + before.position_world) / (h * h);
    const Vec3 force = now.q_world_from_lidar.conjugate() * (acceleration + Vec3(0, 0, kGravity));
    ASSERT_LT((force - state.specific_force_m_s2).norm(), 2e-3) << seconds(t);
  }
}

TEST(RigMotion, StageLeansAboutItsOwnYAndTurnsAboutTheVertical) {
  RigOptions rig;
  rig.tilt = Degrees{60};
  rig.rotation_per_second = Degrees{90};
  const RigMotion motion(rig, 1);
  for (const Duration t : {0s, 1s, 7s}) {
    const Quaternion q = motion.pose_at(t).q_world_from_lidar;
    EXPECT_NEAR((q * Vec3::UnitZ()).z(), 0.5, 1e-12);               // cos 60°
    EXPECT_NEAR((q * Vec3::UnitY()).z(), 0.0, 1e-12);               // y stays level
    EXPECT_NEAR((q * Vec3::UnitX()).z(), -std::sqrt(0.75), 1e-12);  // x dips
  }
  const Vec3 y = motion.pose_at(1s).q_world_from_lidar * Vec3::UnitY();
  EXPECT_TRUE(y.isApprox(Vec3(-1, 0, 0), 1e-12));  // a quarter turn counter-clockwise
}

TEST(RigMotion, SwayHasItsRootMeanSquareAndItsBand) {
  Random random(9, 0);
  const Sway sway(0.1, random);
  double squares = 0;
  double rates = 0;
  constexpr int kSamples = 20'000;
  for (int i = 0; i < kSamples; ++i) {
    const Sway::Motion at = sway.at(i * 10ms);
    squares += at.value * at.value;
    rates += at.rate * at.rate;
  }
  const double rms = std::sqrt(squares / kSamples);
  EXPECT_NEAR(rms, 0.1, 0.002);
  const double hz = std::sqrt(rates / kSamples) / rms / (2 * std::numbers::pi);
  EXPECT_GT(hz, 0.2);
  EXPECT_LT(hz, 3.0);
}

TEST(RigPath, GoesThroughItsPointsAtItsSpeedAndComesBack) {
  const std::vector<Vec3> points{{0, 0, 0}, {4, 0, 0}, {8, 0, 0}, {8, 4, 0}, {8, 8, 0}};
  const RigPath path(points, 1.0, PathEnd::back);
  const Duration round = 20s;  // 6 + 4 + 4 + 6
  EXPECT_LT((path.at(0s).position_m - points[0]).norm(), 1e-12);
  EXPECT_LT((path.at(6s).position_m - points[1]).norm(), 1e-12);
  EXPECT_LT((path.at(10s).position_m - points[2]).norm(), 1e-12);
  EXPECT_LT((path.at(round).position_m - points[4]).norm(), 1e-9);
  EXPECT_LT((path.at(2 * round).position_m - points[0]).norm(), 1e-9);
  EXPECT_LT(path.at(round).velocity_m_s.norm(), 1e-9);
  double fastest = 0;
  double length = 0;
  for (Duration t{0}; t < round; t += 1ms) {
    fastest = std::max(fastest, path.at(t).velocity_m_s.norm());
    length += path.at(t).velocity_m_s.norm() * 1e-3;
  }
  EXPECT_NEAR(length, 16.0, 1.0);
  EXPECT_GT(fastest, 0.9);
  EXPECT_LT(fastest, 1.3);
}

TEST(RigPath, EndsAsItIsToldAndStandsBeforeItsStart) {
  const std::vector<Vec3> points{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}};
  const RigPath stop(points, 1.0, PathEnd::stop);
  EXPECT_EQ(stop.at(-1s).position_m, points[0]);
  EXPECT_LT((stop.at(1h).position_m - points[2]).norm(), 1e-9);
  const RigPath loop(points, 1.0, PathEnd::loop);
  double nearest = HUGE_VAL;  // it comes by its start again
  for (Duration t = 5s; t < 20s; t += 10ms) {
    nearest = std::min(nearest, loop.at(t).position_m.norm());
  }
  EXPECT_LT(nearest, 0.01);
}

TEST(RigPath, RefusesWhatIsNoPath) {
  EXPECT_THROW(RigPath({}, 1.0, PathEnd::stop), std::invalid_argument);
  EXPECT_THROW(RigPath({{0, 0, 0}, {0, 0, 0}}, 1.0, PathEnd::stop), std::invalid_argument);
  EXPECT_THROW(RigPath({{0, 0, 0}}, 0.0, PathEnd::stop), std::invalid_argument);
}

TEST(RigImu, ErrorOfGravityIsFixedInTheWorldAndTheTiltErrorInTheImu) {
  const RigMotion motion(everything(), 5);
  ImuErrors errors = kIdealImu;
  errors.gravity = Degrees{5};
  const RigImu leaning(motion, errors, 5);
  const Quaternion at_start =
      leaning.state(0s).q_level_from_imu * motion.state(0s).q_level_from_imu.conjugate();
  const Quaternion later =
      leaning.state(3s).q_level_from_imu * motion.state(3s).q_level_from_imu.conjugate();
  EXPECT_NEAR(at_start.angularDistance(Quaternion::Identity()), Degrees{5}.to_radians().value,
              1e-9);
  EXPECT_LT(at_start.angularDistance(later), 1e-9);

  errors = kIdealImu;
  errors.tilt = Degrees{0.2};
  const RigImu tilted(motion, errors, 5);
  const auto in_imu = [&](Duration t) {
    return motion.state(t).q_level_from_imu.conjugate() * tilted.state(t).q_level_from_imu;
  };
  EXPECT_NEAR(in_imu(0s).angularDistance(Quaternion::Identity()), Degrees{0.2}.to_radians().value,
              1e-9);
  EXPECT_LT(in_imu(0s).angularDistance(in_imu(3s)), 1e-9);
}

TEST(RigImu, AnIdealOneMeasuresTheTruth) {
  const RigMotion motion(everything(), 5);
  const RigImu ideal(motion, kIdealImu, 5);
  const RigState truth = motion.state(2s);
  const RigState told = ideal.state(2s);
  EXPECT_LT(told.q_level_from_imu.angularDistance(truth.q_level_from_imu), 1e-12);
  EXPECT_LT((told.specific_force_m_s2 - truth.specific_force_m_s2).norm(), 1e-12);
  EXPECT_LT((told.angular_velocity_rad_s - truth.angular_velocity_rad_s).norm(), 1e-12);
}

TEST(ExactSinCos, AgreesWithTheLibrary) {
  for (double angle = -40.0; angle < 2000.0; angle += 0.0371) {
    const SinCos exact = sin_cos(Radians{angle});
    ASSERT_NEAR(exact.sin, std::sin(angle), 2e-15 + 1e-18 * angle) << angle;
    ASSERT_NEAR(exact.cos, std::cos(angle), 2e-15 + 1e-18 * angle) << angle;
  }
}

// Computed apart, by a program that gives the published numbers of SplitMix64: any other would
// change every simulation.
TEST(Random, IsTheSameOnEveryMachine) {
  Random random(1, 0);
  EXPECT_EQ(random.bits(), 0x5F47167DAB1E6F33U);
}

TEST(Random, GaussianHasMeanZeroAndDeviationOne) {
  Random random(3, 1);
  double sum = 0;
  double squares = 0;
  constexpr int kDraws = 100'000;
  for (int i = 0; i < kDraws; ++i) {
    const double g = random.gaussian();
    sum += g;
    squares += g * g;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 5 / std::sqrt(kDraws));
  EXPECT_NEAR(squares / kDraws, 1.0, 5 * std::sqrt(2.0 / kDraws));
}

TEST(Random, PlacesOfOneSeedDiffer) {
  EXPECT_NE(Random(1, 0).bits(), Random(1, 1).bits());
  EXPECT_NE(Random(1, 0, 1).bits(), Random(1, 0, 2).bits());
  EXPECT_NE(Random(1, 0).bits(), Random(2, 0).bits());
}

}  // namespace
}  // namespace convexcut::simulation
