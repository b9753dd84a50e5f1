// SPDX-License-Identifier: Apache-2.0
//
// Does not prove what instant within a datagram the sensor stamps, nor that a sensor's PPS is
// locked.
#include "core/clock/hour_clock.hpp"

#include <chrono>
#include <cstdint>

#include <gtest/gtest.h>

namespace convexcut {
namespace {

using namespace std::chrono_literals;

// 2026-11-22 10:00:00 UTC, a whole hour.
constexpr HostTime kTenOClock{Duration{1'795'341'600'000'000'000}};
static_assert(kTenOClock.time_since_epoch() % kHour == 0ns);

constexpr MicrosPastHour past_hour(std::chrono::microseconds us) {
  return {static_cast<std::uint32_t>(us.count())};
}
constexpr LidarTime utc(HostTime t) { return LidarTime{t.time_since_epoch()}; }

TEST(HourClock, FirstValueIsInTheHoursOfTheHost) {
  HourClock clock;
  EXPECT_EQ(clock.unwrap(past_hour(10min + 5us), kTenOClock + 10min + 300us),
            utc(kTenOClock + 10min + 5us));
}

TEST(HourClock, LastMicrosecondOfTheHourStaysInItWhenTheHostIsAlreadyInTheNext) {
  HourClock clock;
  EXPECT_EQ(clock.unwrap(past_hour(1h - 1us), kTenOClock + 400us), utc(kTenOClock - 1us));
}

TEST(HourClock, FirstMicrosecondOfTheHourIsInItWhenTheHostIsStillInThePrevious) {
  HourClock clock;
  EXPECT_EQ(clock.unwrap(past_hour(1us), kTenOClock - 3s), utc(kTenOClock + 1us));
}

TEST(HourClock, WrapContinues) {
  HourClock clock;
  (void)clock.unwrap(past_hour(1h - 1us), kTenOClock);
  EXPECT_EQ(clock.unwrap(past_hour(552us), kTenOClock + 553us), utc(kTenOClock + 552us));
}

TEST(HourClock, OvershootOfTheHourIsContinuousOnBothSides) {
  HourClock clock;
  (void)clock.unwrap(past_hour(3599s + 999ms), kTenOClock - 1ms);
  EXPECT_EQ(clock.unwrap(past_hour(3600s + 10ms), kTenOClock + 10ms), utc(kTenOClock + 10ms));
  EXPECT_EQ(clock.unwrap(past_hour(11ms), kTenOClock + 11ms), utc(kTenOClock + 11ms));
}

TEST(HourClock, OvershootAsTheFirstValueIsTheNextHour) {
  HourClock clock;
  EXPECT_EQ(clock.unwrap(past_hour(3600s + 10ms), kTenOClock + 11ms), utc(kTenOClock + 10ms));
}

TEST(HourClock, CounterHalfAnHourOffTheHostDoesNotFlip) {
  // A sensor that counts from power-on, 30 min off the host: host jitter moves the nearest hour to
  // and fro, the result must not.
  HourClock clock;
  LidarTime expected = clock.unwrap(past_hour(5min), kTenOClock + 35min - 1us);
  for (int i = 1; i < 200; ++i) {
    const Duration jitter = (i % 2 == 0 ? -1 : 1) * Duration{2ms};
    const LidarTime got =
        clock.unwrap(past_hour(5min + i * 553us), kTenOClock + 35min + i * 553us + jitter);
    expected += 553us;
    ASSERT_EQ(got, expected) << i;
  }
}

TEST(HourClock, SilenceOfHoursIsCountedByTheHost) {
  HourClock clock;
  const LidarTime before = clock.unwrap(past_hour(50min), kTenOClock + 50min);
  // 3 h 25 min later, by a host that drifted 40 s in the meantime.
  EXPECT_EQ(clock.unwrap(past_hour(15min), kTenOClock + 4h + 15min + 40s) - before, 3h + 25min);
}

TEST(HourClock, SilenceOfLittleMoreThanHalfAnHourIsNotTakenForAStepBack) {
  HourClock clock;
  const LidarTime before = clock.unwrap(past_hour(10min), kTenOClock + 10min);
  EXPECT_EQ(clock.unwrap(past_hour(41min), kTenOClock + 41min) - before, 31min);
}

TEST(HourClock, ReorderedDatagramIsEarlierAlsoAcrossTheHour) {
  HourClock clock;
  (void)clock.unwrap(past_hour(1h - 600us), kTenOClock - 300us);
  EXPECT_EQ(clock.unwrap(past_hour(506us), kTenOClock + 806us), utc(kTenOClock + 506us));
  EXPECT_EQ(clock.unwrap(past_hour(1h - 47us), kTenOClock + 810us), utc(kTenOClock - 47us));
  EXPECT_EQ(clock.unwrap(past_hour(1059us), kTenOClock + 1359us), utc(kTenOClock + 1059us));
}

TEST(HourClock, HostALittleOffTheSensorRunsThroughTheHourWithoutAJump) {
  for (const Duration host_error : {Duration{-20s}, Duration{-1ms}, Duration{1ms}, Duration{20s}}) {
    HourClock clock;
    for (std::int64_t us = -1'000'000; us < 1'000'000; us += 553) {
      const HostTime truth = kTenOClock + std::chrono::microseconds{us};
      const MicrosPastHour counter = past_hour((3600s + std::chrono::microseconds{us}) % 3600s);
      ASSERT_EQ(clock.unwrap(counter, truth + host_error), utc(truth)) << us;
    }
  }
}

TEST(HourClock, HostThatIsSetByMinutesMovesNothing) {
  HourClock clock;
  (void)clock.unwrap(past_hour(20min), kTenOClock + 20min);
  EXPECT_EQ(clock.unwrap(past_hour(20min + 1ms), kTenOClock + 45min),
            utc(kTenOClock + 20min + 1ms));
}

TEST(HourClock, RecordingThatStartsOverGoesBackByItsLength) {
  HourClock clock;
  const LidarTime start = clock.unwrap(past_hour(20min), kTenOClock + 20min);
  (void)clock.unwrap(past_hour(35min), kTenOClock + 2h + 35min);
  EXPECT_EQ(clock.unwrap(past_hour(20min), kTenOClock + 20min), start);
}

TEST(HourClock, EveryCounterValueIsAccepted) {
  HourClock clock;
  const LidarTime garbage = clock.unwrap({0xFFFF'FFFF}, kTenOClock);
  EXPECT_LE(garbage - utc(kTenOClock), 30min);
  EXPECT_GE(garbage - utc(kTenOClock), -30min);
}

TEST(HourClock, ResetAnchorsToTheHostAgain) {
  HourClock clock;
  (void)clock.unwrap(past_hour(20min), kTenOClock + 49min);
  clock.reset();
  EXPECT_EQ(clock.unwrap(past_hour(20min), kTenOClock + 51min), utc(kTenOClock + 1h + 20min));
}

}  // namespace
}  // namespace convexcut
