// SPDX-License-Identifier: Apache-2.0
//
// Interpolation and ageing. Does not prove that the orientations are right or their times mapped
// well.
#include "core/scan/orientation_track.hpp"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace convexcut {
namespace {

using namespace std::chrono_literals;

constexpr HostTime kStart{Duration{1'795'341'600'000'000'000}};

Quaternion yaw(double degrees) { return to_quaternion({{}, {}, Degrees{degrees}}); }
double yaw_degrees(const Orientation& o) {
  const Quaternion& q = o.rotation;
  return to_degrees(Radians{2.0 * std::atan2(q.z(), q.w())}).value;
}

TEST(OrientationTrack, EmptyTrackHasNothing) {
  const OrientationTrack track(8);
  EXPECT_EQ(track.at(kStart).quality, OrientationQuality::missing);
  EXPECT_FALSE(track.newest().has_value());
}

TEST(OrientationTrack, BetweenSamplesIsInterpolated) {
  OrientationTrack track(8);
  track.push(kStart, yaw(10));
  track.push(kStart + 10ms, yaw(20));
  const Orientation o = track.at(kStart + 3ms);
  EXPECT_EQ(o.quality, OrientationQuality::interpolated);
  EXPECT_NEAR(yaw_degrees(o), 13.0, 1e-9);
}

TEST(OrientationTrack, SampleItselfIsReturnedAtItsTime) {
  OrientationTrack track(8);
  track.push(kStart, yaw(10));
  track.push(kStart + 200ms, yaw(20));
  EXPECT_EQ(track.at(kStart).quality, OrientationQuality::interpolated);
  EXPECT_EQ(track.at(kStart + 200ms).quality, OrientationQuality::interpolated);
  EXPECT_NEAR(yaw_degrees(track.at(kStart + 200ms)), 20.0, 1e-9);
}

// q and −q are one rotation; devices switch between them.
TEST(OrientationTrack, InterpolationTakesTheShortWayWhateverTheSign) {
  OrientationTrack track(8);
  Quaternion negated = yaw(20);
  negated.coeffs() *= -1.0;
  track.push(kStart, yaw(10));
  track.push(kStart + 10ms, negated);
  const Quaternion q = track.at(kStart + 5ms).rotation;
  EXPECT_LT(q.angularDistance(yaw(15)), 1e-9);
}

TEST(OrientationTrack, GapOfFiftyMillisecondsIsStillInterpolated) {
  OrientationTrack track(8);
  track.push(kStart, yaw(0));
  track.push(kStart + 50ms, yaw(10));
  EXPECT_EQ(track.at(kStart + 49ms).quality, OrientationQuality::interpolated);
}

TEST(OrientationTrack, WiderGapIsHeldForFiftyMillisecondsThenMissing) {
  OrientationTrack track(8);
  track.push(kStart, yaw(0));
  track.push(kStart + 120ms, yaw(90));
  const Orientation held = track.at(kStart + 50ms);
  EXPECT_EQ(held.quality, OrientationQuality::held);
  EXPECT_NEAR(yaw_degrees(held), 0.0, 1e-12);
  EXPECT_EQ(track.at(kStart + 50ms + 1ns).quality, OrientationQuality::missing);
  EXPECT_EQ(track.at(kStart + 119ms).quality, OrientationQuality::missing);
}

TEST(OrientationTrack, AfterTheNewestIsHeldForFiftyMillisecondsThenMissing) {
  OrientationTrack track(8);
  track.push(kStart, yaw(0));
  track.push(kStart + 10ms, yaw(1));
  EXPECT_EQ(track.at(kStart + 11ms).quality, OrientationQuality::held);
  EXPECT_NEAR(yaw_degrees(track.at(kStart + 60ms)), 1.0, 1e-9);
  EXPECT_EQ(track.at(kStart + 60ms + 1ns).quality, OrientationQuality::missing);
}

TEST(OrientationTrack, BeforeTheOldestIsMissing) {
  OrientationTrack track(8);
  track.push(kStart, yaw(0));
  EXPECT_EQ(track.at(kStart - 1ns).quality, OrientationQuality::missing);
}

TEST(OrientationTrack, NotNewerIsRefusedAndCounted) {
  OrientationTrack track(8);
  EXPECT_TRUE(track.push(kStart, yaw(0)));
  EXPECT_FALSE(track.push(kStart, yaw(1)));
  EXPECT_FALSE(track.push(kStart - 1ms, yaw(2)));
  EXPECT_EQ(track.refused(), 2U);
  EXPECT_EQ(track.size(), 1U);
}

TEST(OrientationTrack, UnusableQuaternionIsRefused) {
  OrientationTrack track(8);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(track.push(kStart, Quaternion(nan, 0, 0, 0)));
  EXPECT_FALSE(track.push(kStart, Quaternion(1, infinity, 0, 0)));
  EXPECT_FALSE(track.push(kStart, Quaternion(0, 0, 0, 0)));
  EXPECT_EQ(track.refused(), 3U);
  EXPECT_EQ(track.size(), 0U);
}

TEST(OrientationTrack, SamplesAreMadeOfUnitLength) {
  OrientationTrack track(8);
  track.push(kStart, Quaternion(2, 0, 0, 0));
  EXPECT_NEAR(track.at(kStart).rotation.norm(), 1.0, 1e-15);
}

TEST(OrientationTrack, OldestGiveWayWhenFull) {
  OrientationTrack track(4);
  for (int i = 0; i < 10; ++i) track.push(kStart + i * 10ms, yaw(i));
  EXPECT_EQ(track.size(), 4U);
  EXPECT_EQ(track.at(kStart + 59ms).quality, OrientationQuality::missing);
  EXPECT_NEAR(yaw_degrees(track.at(kStart + 65ms)), 6.5, 1e-9);
  EXPECT_EQ(track.newest(), kStart + 90ms);
}

TEST(OrientationTrack, ClearedTrackTakesEarlierTimes) {
  OrientationTrack track(4);
  track.push(kStart, yaw(0));
  track.clear();
  EXPECT_EQ(track.at(kStart).quality, OrientationQuality::missing);
  EXPECT_TRUE(track.push(kStart - 1h, yaw(0)));
}

TEST(OrientationTrack, InterpolationIsThatOfSlerpForAnyTurn) {
  for (double degrees = 0.0; degrees < 180.0; degrees += 7.5) {
    const Quaternion from = to_quaternion({Degrees{10}, Degrees{-20}, Degrees{30}});
    const Quaternion to = from * Quaternion(Eigen::AngleAxisd(Degrees{degrees}.to_radians().value,
                                                              Vec3(1, 2, -2).normalized()));
    OrientationTrack track(4);
    track.push(kStart, from);
    track.push(kStart + 40ms, to);
    for (int k = 0; k <= 40; ++k) {
      const Quaternion expected = from.slerp(k / 40.0, to);
      EXPECT_NEAR(std::abs(track.at(kStart + k * 1ms).rotation.dot(expected)), 1.0, 1e-14);
      EXPECT_LT(track.at(kStart + k * 1ms).rotation.angularDistance(expected), 1e-7);
    }
  }
}

TEST(OrientationTrack, WhatWasInterpolatedBeforeIsForgottenWithItsSamples) {
  OrientationTrack track(2);
  track.push(kStart, Quaternion::Identity());
  track.push(kStart + 10ms, Quaternion::Identity());
  EXPECT_NE(track.at(kStart + 5ms).quality, OrientationQuality::missing);
  track.push(kStart + 20ms, Quaternion::Identity());
  EXPECT_EQ(track.at(kStart + 5ms).quality, OrientationQuality::missing);
  EXPECT_NE(track.at(kStart + 15ms).quality, OrientationQuality::missing);
  track.clear();
  EXPECT_EQ(track.at(kStart + 15ms).quality, OrientationQuality::missing);
}

TEST(OrientationTrack, MaxAgeIsConfigurable) {
  OrientationTrack track(4, 5ms);
  track.push(kStart, yaw(0));
  EXPECT_EQ(track.at(kStart + 5ms).quality, OrientationQuality::held);
  EXPECT_EQ(track.at(kStart + 6ms).quality, OrientationQuality::missing);
}

TEST(OrientationTrack, ImpossibleOptionsAreRefused) {
  EXPECT_THROW(OrientationTrack(0), std::invalid_argument);
  EXPECT_THROW(OrientationTrack(4, -1ms), std::invalid_argument);
}

// The cursor must not show: any order of queries, also between pushes that wrap the buffer, gives
// what a fresh track gives.
TEST(OrientationTrack, OrderOfQueriesDoesNotMatter) {
  std::mt19937 random(3);
  OrientationTrack track(16);
  for (int i = 0; i < 200; ++i) {
    track.push(kStart + i * 10ms, yaw(i));
    for (int k = 0; k < 20; ++k) {
      const HostTime t = kStart + i * 10ms - Duration{random() % 170'000'000} + 10ms;
      OrientationTrack fresh = track;
      fresh.clear();
      for (int n = std::max(0, i - 15); n <= i; ++n) fresh.push(kStart + n * 10ms, yaw(n));
      const Orientation got = track.at(t);
      const Orientation expected = fresh.at(t);
      ASSERT_EQ(got.quality, expected.quality);
      ASSERT_EQ(got.rotation.coeffs(), expected.rotation.coeffs());
    }
  }
}

}  // namespace
}  // namespace convexcut
