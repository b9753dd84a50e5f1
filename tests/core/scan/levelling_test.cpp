// SPDX-License-Identifier: Apache-2.0
//
// Rotation of points by the orientation at their time. Does not prove the mounting angles of a real
// sensor, nor motion of its position (only rotation is taken out).
#include "core/scan/levelling.hpp"

#include <chrono>
#include <cmath>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/simd/simd_path.hpp"
#include "tests/core/scan/rotation.hpp"
#include "tests/core/scan/synthetic_lidar.hpp"

namespace convexcut {
namespace {

using namespace std::chrono_literals;
using test::rpy;
using testing::Each;
using testing::ElementsAre;
using testing::FloatNear;

constexpr HostTime kStamp{Duration{1'795'341'600'000'000'000}};
constexpr LidarTime kFirst{Duration{1h}};

void add_firing(Scan& scan, Duration after_first, const std::vector<Vec3>& p_lidar) {
  const auto first = static_cast<std::uint32_t>(scan.size());
  scan.firings.push_back({kFirst + after_first, first, static_cast<std::uint32_t>(p_lidar.size())});
  for (const Vec3& p : p_lidar) {
    scan.x_lidar.push_back(static_cast<float>(p.x()));
    scan.y_lidar.push_back(static_cast<float>(p.y()));
    scan.z_lidar.push_back(static_cast<float>(p.z()));
    scan.intensity.push_back(static_cast<std::uint8_t>(scan.size()));
    scan.ring.push_back(static_cast<std::uint8_t>(scan.size() % 32));
    scan.time_ns.push_back(static_cast<std::uint32_t>(after_first.count()));
  }
  scan.first_firing = kFirst;
  scan.last_firing = kFirst + after_first;
}

LevelledScan reserved(std::size_t points) {
  LevelledScan levelled;
  reserve(levelled, points);
  return levelled;
}

void expect_point(const LevelledScan& scan, std::size_t i, const Vec3& expected) {
  EXPECT_THAT((std::vector<float>{scan.x[i], scan.y[i], scan.z[i]}),
              ElementsAre(FloatNear(static_cast<float>(expected.x()), 1e-5F),
                          FloatNear(static_cast<float>(expected.y()), 1e-5F),
                          FloatNear(static_cast<float>(expected.z()), 1e-5F)))
      << i;
}

TEST(Levelling, FixedMountIsTakenOut) {
  Scan scan;
  add_firing(scan, 0ms, {{1, 2, 3}, {-4, 5, 0.5}});
  LevelledScan levelled = reserved(10);
  const Quaternion q_level_from_lidar = rpy(5, -12, 80);
  level(scan, kStamp, q_level_from_lidar, levelled);
  expect_point(levelled, 0, q_level_from_lidar * Vec3(1, 2, 3));
  expect_point(levelled, 1, q_level_from_lidar * Vec3(-4, 5, 0.5));
}

TEST(Levelling, MountIsAppliedBeforeTheImusOrientation) {
  Scan scan;
  add_firing(scan, 0ms, {{1, 2, 3}});
  OrientationTrack track(4);
  const Quaternion q_level_from_imu = rpy(20, 0, 0);
  const Quaternion q_imu_from_lidar = rpy(0, 0, 90);
  track.push(kStamp, q_level_from_imu);
  LevelledScan levelled = reserved(10);
  level(scan, kStamp, track, q_imu_from_lidar, levelled);
  expect_point(levelled, 0, q_level_from_imu * (q_imu_from_lidar * Vec3(1, 2, 3)));
}

// A wall point seen from a turning sensor: in the lidar's frame it moves, in level it must not.
TEST(Levelling, RotationDuringTheScanIsTakenOut) {
  const Vec3 p_level(7.0, -3.0, 1.5);
  const auto orientation = [](Duration t) {
    const Radians angle = Degrees{200.0 * static_cast<double>(t.count()) * 1e-9}.to_radians();
    return Quaternion(Eigen::AngleAxisd(angle.value, Vec3(1, -2, 5).normalized()));
  };
  OrientationTrack track(100);
  for (Duration t = 0ms; t <= 120ms; t += 2500us) track.push(kStamp + t, orientation(t));
  const Quaternion q_imu_from_lidar = rpy(1, 2, 3);
  Scan scan;
  for (Duration t = 0ms; t < 100ms; t += 461us) {
    add_firing(scan, t, {(orientation(t) * q_imu_from_lidar).conjugate() * p_level});
  }
  LevelledScan levelled = reserved(scan.size());
  level(scan, kStamp, track, q_imu_from_lidar, levelled);
  ASSERT_EQ(levelled.size(), scan.size());
  for (std::size_t i = 0; i < levelled.size(); ++i) expect_point(levelled, i, p_level);
}

// Firings of any number of returns, so that vectors reach into the next one and past the last.
TEST(Levelling, EveryInstructionSetGivesTheSameBits) {
  Scan scan;
  OrientationTrack track(40);
  for (int i = 0; i < 40; ++i) {
    std::vector<Vec3> points;
    for (int k = 0; k < i; ++k) points.emplace_back(0.7 * i, 1.3 * k - 9.0, 0.1 * i * k - 3.0);
    add_firing(scan, i * 1ms, points);
    if (i != 20) track.push(kStamp + i * 1ms, rpy(0.5 * i, 30.0 - i, 4.0 * i));
  }
  std::vector<float> expected;
  for (std::size_t i = 0; i < scan.firings.size(); ++i) {
    const Orientation at = track.at(kStamp + (scan.firings[i].time - kFirst));
    const Eigen::Matrix3f r = at.rotation.toRotationMatrix().cast<float>();
    for (std::size_t k = 0; k < scan.firings[i].return_count; ++k) {
      const std::size_t p = scan.firings[i].first_return + k;
      expected.push_back(r(0, 0) * scan.x_lidar[p] + r(0, 1) * scan.y_lidar[p] +
                         r(0, 2) * scan.z_lidar[p]);
    }
  }
  for (const std::string_view path : simd_paths()) {
    ASSERT_TRUE(use_simd_path(path));
    LevelledScan levelled = reserved(scan.size());
    level(scan, kStamp, track, Quaternion::Identity(), levelled);
    EXPECT_EQ(levelled.x, expected) << path;
    EXPECT_EQ(levelled.ring, scan.ring) << path;
    EXPECT_EQ(levelled.time_ns, scan.time_ns) << path;
  }
  ASSERT_TRUE(use_simd_path("auto"));
}

TEST(Levelling, PointsWithoutAnOrientationAreDroppedAndCounted) {
  Scan scan;
  add_firing(scan, 0ms, {{1, 0, 0}, {2, 0, 0}});
  add_firing(scan, 60ms, {{3, 0, 0}});
  add_firing(scan, 80ms, {});
  add_firing(scan, 100ms, {{4, 0, 0}, {5, 0, 0}});
  OrientationTrack track(4);
  track.push(kStamp - 1ms, Quaternion::Identity());
  track.push(kStamp + 90ms, Quaternion::Identity());
  LevelledScan levelled = reserved(10);
  level(scan, kStamp, track, Quaternion::Identity(), levelled);
  EXPECT_THAT(levelled.x, ElementsAre(1, 2, 4, 5));
  EXPECT_THAT(levelled.time_ns, ElementsAre(0, 0, 100'000'000, 100'000'000));
  EXPECT_THAT(levelled.intensity, ElementsAre(1, 2, 4, 5));
  EXPECT_THAT(levelled.ring, ElementsAre(1, 2, 4, 5));
  EXPECT_EQ(levelled.label.size(), 4U);
  EXPECT_EQ(levelled.dropped_no_orientation, 1U);
}

TEST(Levelling, AStrideTakesWholeFirings) {
  Scan scan;
  for (int i = 0; i < 5; ++i) {
    add_firing(scan, i * 1ms, {{1.0 * i, 0, 0}, {1.0 * i, 1, 0}});
  }
  OrientationTrack track(4);
  track.push(kStamp, Quaternion::Identity());
  LevelledScan by_imu = reserved(10);
  LevelledScan fixed = reserved(10);
  level(scan, kStamp, track, Quaternion::Identity(), by_imu, 2);
  level(scan, kStamp, Quaternion::Identity(), fixed, 2);
  for (const LevelledScan* levelled : {&by_imu, &fixed}) {
    EXPECT_THAT(levelled->x, ElementsAre(0, 0, 2, 2, 4, 4));
    EXPECT_THAT(levelled->y, ElementsAre(0, 1, 0, 1, 0, 1));
    EXPECT_EQ(levelled->label.size(), 6U);
  }
}

TEST(Levelling, WithoutAnyOrientationNothingIsLeft) {
  Scan scan;
  add_firing(scan, 0ms, {{1, 0, 0}, {2, 0, 0}});
  LevelledScan levelled = reserved(10);
  level(scan, kStamp, OrientationTrack(4), Quaternion::Identity(), levelled);
  EXPECT_EQ(levelled.size(), 0U);
  EXPECT_EQ(levelled.dropped_no_orientation, 2U);
}

TEST(Levelling, HeaderIsCarriedOver) {
  Scan scan;
  scan.index = 42;
  scan.end = ScanEnd::timeout;
  scan.expected_firings = 4;
  scan.overflow_returns = 3;
  add_firing(scan, 0ms, {{1, 0, 0}});
  add_firing(scan, 7ms, {{1, 0, 0}});
  LevelledScan levelled = reserved(10);
  levelled.structure_points = 99;
  level(scan, kStamp, Quaternion::Identity(), levelled);
  EXPECT_EQ(levelled.index, 42U);
  EXPECT_EQ(levelled.end, ScanEnd::timeout);
  EXPECT_EQ(levelled.stamp, kStamp);
  EXPECT_EQ(levelled.last_firing, kStamp + 7ms);
  EXPECT_EQ(levelled.coverage, 0.5);
  EXPECT_EQ(levelled.overflow_returns, 3U);
  EXPECT_EQ(levelled.structure_points, 0U);
}

TEST(Levelling, RemainsOfAnEarlierScanAreGone) {
  Scan scan;
  add_firing(scan, 0ms, {{1, 0, 0}, {2, 0, 0}});
  LevelledScan levelled = reserved(10);
  levelled.x.assign(9, 7.0F);
  levelled.label.assign(9, Label::structure);
  levelled.dropped_no_orientation = 5;
  level(scan, kStamp, Quaternion::Identity(), levelled);
  EXPECT_THAT(levelled.x, ElementsAre(1, 2));
  EXPECT_EQ(levelled.label.size(), 2U);
  EXPECT_THAT(levelled.label, Each(Label::other));
  EXPECT_EQ(levelled.dropped_no_orientation, 0U);
}

TEST(Levelling, PointsBeyondTheCapacityAreCounted) {
  Scan scan;
  add_firing(scan, 0ms, {{1, 0, 0}, {2, 0, 0}});
  add_firing(scan, 1ms, {{3, 0, 0}, {4, 0, 0}});
  LevelledScan levelled = reserved(3);
  OrientationTrack track(4);
  track.push(kStamp, Quaternion::Identity());
  level(scan, kStamp, track, Quaternion::Identity(), levelled);
  EXPECT_THAT(levelled.x, ElementsAre(1, 2, 3));
  EXPECT_EQ(levelled.overflow_returns, 1U);
}

TEST(Levelling, EmptyScanGivesAnEmptyScan) {
  LevelledScan levelled = reserved(3);
  level(Scan{}, kStamp, Quaternion::Identity(), levelled);
  EXPECT_EQ(levelled.size(), 0U);
  EXPECT_EQ(levelled.coverage, 0.0);
}

}  // namespace
}  // namespace convexcut
