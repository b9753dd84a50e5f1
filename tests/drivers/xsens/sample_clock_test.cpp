// SPDX-License-Identifier: Apache-2.0
//
// Unwrapping of sample times. Does not prove after how many ticks a real device wraps: both known
// ways are covered.
#include "drivers/xsens/sample_clock.hpp"

#include <gtest/gtest.h>

#include "drivers/xsens/sample_time.hpp"

namespace convexcut::xsens {
namespace {

constexpr std::uint32_t kDay = 864'000'000;
constexpr Duration kTick = std::chrono::microseconds{100};

TEST(SampleClock, TicksAreHundredMicroseconds) {
  SampleClock clock = SampleClock::sample_time_fine();
  EXPECT_EQ(to_ns(clock.unwrap(51703223)), 5'170'322'300'000);
  EXPECT_EQ(to_ns(clock.unwrap(51703323)), 5'170'332'300'000);
}

TEST(SampleClock, RunsOnAcrossTheWrapOfADay) {
  SampleClock clock = SampleClock::sample_time_fine();
  const ImuTime before = clock.unwrap(kDay - 50);
  EXPECT_EQ(clock.unwrap(50) - before, 100 * kTick);
}

TEST(SampleClock, RunsOnPastADayWhereTheDeviceDoesNotWrapThere) {
  SampleClock clock = SampleClock::sample_time_fine();
  const ImuTime before = clock.unwrap(kDay - 50);
  EXPECT_EQ(clock.unwrap(kDay + 50) - before, 100 * kTick);
}

TEST(SampleClock, RunsOnAcrossTheWrapOfTheField) {
  SampleClock clock = SampleClock::sample_time_fine();
  const ImuTime before = clock.unwrap(0xFFFFFFFF - 49);
  EXPECT_EQ(clock.unwrap(50) - before, 100 * kTick);
}

TEST(SampleClock, OlderNeighboursStepBackOnly) {
  SampleClock clock = SampleClock::sample_time_fine();
  const ImuTime first = clock.unwrap(51703223);
  EXPECT_EQ(clock.unwrap(51703223 - 450) - first, -450 * kTick);
  EXPECT_EQ(clock.unwrap(51703323) - first, 100 * kTick);
}

TEST(SampleClock, OlderNeighbourFromBeforeTheWrapStepsBackAcrossIt) {
  for (const std::uint64_t wrap : {std::uint64_t{kDay}, std::uint64_t{1} << 32}) {
    SampleClock clock = SampleClock::sample_time_fine();
    clock.unwrap(static_cast<std::uint32_t>(wrap - 100));
    const ImuTime after = clock.unwrap(10);
    EXPECT_EQ(clock.unwrap(static_cast<std::uint32_t>(wrap - 440)) - after, -450 * kTick);
    EXPECT_EQ(clock.unwrap(110) - after, 100 * kTick);
  }
}

TEST(SampleClock, ManyDaysAreCounted) {
  SampleClock clock = SampleClock::sample_time_fine();
  const ImuTime start = clock.unwrap(0);
  ImuTime now = start;
  for (std::uint64_t tick = 0; tick <= 10ULL * kDay; tick += kDay / 16) {
    now = clock.unwrap(static_cast<std::uint32_t>(tick % kDay));
  }
  EXPECT_EQ(now - start, 240 * kHour);
}

TEST(SampleClock, ARestartWithinHalfADayStepsBack) {
  SampleClock clock = SampleClock::sample_time_fine();
  const ImuTime before = clock.unwrap(100'000'000);
  EXPECT_EQ(clock.unwrap(0) - before, -100'000'000 * kTick);
}

TEST(SampleClock, CanTimeIsMicrosecondsAndWrapsAtTheField) {
  SampleClock clock = SampleClock::can_sample_time();
  const ImuTime before = clock.unwrap(0xFFFFFFFF - 4'999);
  EXPECT_EQ(clock.unwrap(5'000) - before, std::chrono::milliseconds{10});
  EXPECT_EQ(to_ns(before), (0xFFFFFFFFLL - 4'999) * 1000);
}

TEST(SampleClock, CanTimeDoesNotWrapAfterADaysTicks) {
  SampleClock clock = SampleClock::can_sample_time();
  const ImuTime before = clock.unwrap(kDay - 1);
  EXPECT_EQ(clock.unwrap(kDay + 1) - before, std::chrono::microseconds{2});
}

TEST(SampleClock, NonsenseStaysDefined) {
  SampleClock clock = SampleClock::sample_time_fine();
  ImuTime latest{};
  for (int i = 0; i < 100'000; ++i) {  // each round adds five days: would overflow int64
    clock.unwrap(0);
    latest = std::max(latest, clock.unwrap(0xF0000000));
  }
  EXPECT_GT(to_ns(latest), std::int64_t{1} << 61);
  EXPECT_LE(to_ns(latest), std::int64_t{1} << 62);
}

TEST(SampleTime, CoarseAndFineGiveTheSameWhetherFineCountsOnOrNot) {
  MtMeasurement m;
  m.sample_time_fine = 51747718;
  m.add(MtItem::sample_time_fine);
  EXPECT_EQ(sample_time_ticks(m), 51747718U);
  m.sample_time_coarse = 5174;
  m.add(MtItem::sample_time_coarse);
  EXPECT_EQ(sample_time_ticks(m), 51747718U);
  m.sample_time_fine = 7718;
  EXPECT_EQ(sample_time_ticks(m), 51747718U);
}

TEST(SampleTime, CoarseAloneIsNoSampleTime) {
  MtMeasurement m;
  m.add(MtItem::sample_time_coarse);
  EXPECT_FALSE(sample_time_ticks(m));
}

}  // namespace
}  // namespace convexcut::xsens
