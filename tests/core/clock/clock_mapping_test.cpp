// SPDX-License-Identifier: Apache-2.0
//
// Delays are simulated (exponential, batched, stalled). Does not prove which delays a real adapter
// or network card has, nor a delay that never falls below a constant: no one-way estimate can see
// that.
#include "core/clock/clock_mapping.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace convexcut {
namespace {

using namespace std::chrono_literals;

constexpr HostTime kStart{Duration{1'795'341'600'000'000'000}};

// A sensor of constant skew and a line that delays its samples.
class Simulation {
 public:
  Duration period = 10ms;
  double skew_ppm = 0.0;
  Duration mean_delay = 1ms;
  Duration batch = 0ms;  // the host sees samples only at multiples of this
  HostTime host_zero = kStart;
  Duration sensor_zero = 1234s;

  [[nodiscard]] HostTime truth(ImuTime sensor) const {
    const Duration elapsed = sensor.time_since_epoch() - sensor_zero;
    return host_zero + elapsed +
           Duration{std::llround(static_cast<double>(elapsed.count()) * skew_ppm * 1e-6)};
  }

  // Feeds samples for `span`; calls check(sensor time) after each.
  template <class Check>
  void run(ClockMapping<ImuTime>& mapping, Duration span, Check&& check) {
    for (const Duration end = elapsed_ + span; elapsed_ < end; elapsed_ += period) {
      const ImuTime sensor{sensor_zero + elapsed_};
      HostTime arrival = truth(sensor) + extra_delay + delay();
      if (batch > 0ns) {
        const Duration since = arrival - host_zero;
        arrival = host_zero + (since / batch + 1) * batch;
      }
      mapping.observe(sensor, arrival);
      check(sensor);
    }
  }
  void run(ClockMapping<ImuTime>& mapping, Duration span) {
    run(mapping, span, [](ImuTime) {});
  }
  [[nodiscard]] ImuTime now() const { return ImuTime{sensor_zero + elapsed_ - period}; }
  [[nodiscard]] Duration error(const ClockMapping<ImuTime>& mapping, ImuTime sensor) const {
    return mapping.to_host(sensor) - truth(sensor);
  }

  Duration extra_delay{0};

 private:
  Duration delay() {
    if (mean_delay == 0ns) return 0ns;
    return Duration{
        std::llround(-std::log(1.0 - uniform_(random_)) * static_cast<double>(mean_delay.count()))};
  }
  std::mt19937_64 random_{7};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  Duration elapsed_{0};
};

Duration worst_error_after_lock(Simulation& line, Duration span) {
  ClockMapping<ImuTime> mapping;
  Duration worst{0};
  line.run(mapping, span, [&](ImuTime sensor) {
    if (mapping.state().locked) {
      worst = std::max(worst, Duration{std::chrono::abs(line.error(mapping, sensor))});
    }
  });
  EXPECT_TRUE(mapping.state().locked);
  return worst;
}

TEST(ClockMapping, FirstSampleGivesTheOffset) {
  ClockMapping<ImuTime> mapping;
  mapping.observe(ImuTime{5s}, kStart);
  EXPECT_EQ(mapping.to_host(ImuTime{7s}), kStart + 2s);
  EXPECT_EQ(mapping.state().samples, 1U);
  EXPECT_FALSE(mapping.state().locked);
}

TEST(ClockMapping, BeforeThereIsASpanTheOffsetIsTheLowestAndTheSkewZero) {
  ClockMapping<ImuTime> mapping;
  mapping.observe(ImuTime{0ms}, kStart + 9ms);
  mapping.observe(ImuTime{10ms}, kStart + 10ms + 2ms);
  mapping.observe(ImuTime{20ms}, kStart + 20ms + 5ms);
  EXPECT_EQ(mapping.to_host(ImuTime{20ms}), kStart + 20ms + 2ms);
  EXPECT_EQ(mapping.state().skew_ppm, 0.0);
}

TEST(ClockMapping, DelayFreeLineIsMappedExactly) {
  Simulation line;
  line.mean_delay = 0ns;
  EXPECT_EQ(worst_error_after_lock(line, 100s), 0ns);
}

// 100 samples a second of 1 ms mean exponential delay: the lowest of a second is ~10 µs late.
TEST(ClockMapping, ExponentialDelayAndDriftStayWithinTwentyMicroseconds) {
  for (const double skew : {-150.0, -50.0, 0.0, 50.0, 150.0}) {
    Simulation line;
    line.skew_ppm = skew;
    EXPECT_LT(worst_error_after_lock(line, 240s), 20us) << skew;
  }
}

TEST(ClockMapping, SkewIsFoundWithinOnePartInAMillion) {
  for (const double skew : {-150.0, -50.0, 0.0, 50.0, 150.0}) {
    Simulation line;
    line.skew_ppm = skew;
    ClockMapping<ImuTime> mapping;
    line.run(mapping, 100s);
    EXPECT_NEAR(mapping.state().skew_ppm, skew, 1.0);
  }
}

// A USB serial adapter that hands its bytes on every 16 ms.
TEST(ClockMapping, SixteenMillisecondBatchesStayWithinOneMillisecond) {
  for (const double skew : {-50.0, 0.0, 50.0}) {
    Simulation line;
    line.skew_ppm = skew;
    line.period = 2500us;
    line.mean_delay = 300us;
    line.batch = 16ms;
    EXPECT_LT(worst_error_after_lock(line, 340s), 1ms) << skew;
  }
}

TEST(ClockMapping, JitterIsTheRootMeanSquareOfTheDelays) {
  Simulation line;  // exponential of mean 1 ms: root mean square √2 ms
  ClockMapping<ImuTime> mapping;
  line.run(mapping, 60s);
  EXPECT_NEAR(static_cast<double>(mapping.state().jitter.count()), 1.414e6, 0.1e6);
}

// The lowest of a second is 0.2 ms late here: every second brings a line that is some 0.1 ms off
// the one before. Told at once, that would be more than the 46 µs between two scans.
TEST(ClockMapping, MappedTimeDoesNotJumpWhileTheEstimateImproves) {
  Simulation line;
  line.skew_ppm = 80.0;
  line.mean_delay = 20ms;
  ClockMapping<ImuTime> mapping;
  line.run(mapping, 20s);
  ASSERT_TRUE(mapping.state().locked);
  HostTime before = mapping.to_host(line.now());
  line.run(mapping, 100s, [&](ImuTime sensor) {
    const HostTime mapped = mapping.to_host(sensor);
    // 10 ms at no more than the skew's bound and the slewing together.
    ASSERT_LE(std::chrono::abs(mapped - before - line.period), 4us);
    before = mapped;
  });
}

TEST(ClockMapping, SkewIsBounded) {
  Simulation line;
  line.skew_ppm = 5000.0;
  ClockMapping<ImuTime> mapping;
  line.run(mapping, 60s);
  EXPECT_LE(mapping.state().skew_ppm, 200.0);
}

TEST(ClockMapping, OneSampleThatWasHeldUpForSecondsChangesNothing) {
  Simulation line;
  line.mean_delay = 0ns;
  ClockMapping<ImuTime> mapping;
  line.run(mapping, 30s);
  line.extra_delay = 3s;
  line.run(mapping, 10ms);
  line.extra_delay = 0s;
  line.run(mapping, 30s);
  EXPECT_EQ(mapping.state().steps, 0U);
  EXPECT_EQ(line.error(mapping, line.now()), 0ns);
}

class ClockMappingHostStep : public testing::TestWithParam<Duration> {};

TEST_P(ClockMappingHostStep, IsFollowedAndCountedOnce) {
  Simulation line;
  line.skew_ppm = 20.0;
  ClockMapping<ImuTime> mapping;
  line.run(mapping, 30s);
  line.host_zero += GetParam();
  line.run(mapping, 5s);
  EXPECT_EQ(mapping.state().steps, 1U);
  EXPECT_LT(std::chrono::abs(line.error(mapping, line.now())), 5ms);
  line.run(mapping, 30s);
  EXPECT_EQ(mapping.state().steps, 1U);
  EXPECT_TRUE(mapping.state().locked);
  EXPECT_LT(std::chrono::abs(line.error(mapping, line.now())), 50us);
}

INSTANTIATE_TEST_SUITE_P(Forward, ClockMappingHostStep, testing::Values(1h, 24h, 2s));
INSTANTIATE_TEST_SUITE_P(Backward, ClockMappingHostStep, testing::Values(-1h, -24h, -2s));

TEST(ClockMapping, SensorThatRestartsIsFollowedAtOnce) {
  Simulation line;
  line.mean_delay = 0ns;
  ClockMapping<ImuTime> mapping;
  line.run(mapping, 30s);
  ClockMapping<ImuTime>& same = mapping;
  Simulation restarted;
  restarted.mean_delay = 0ns;
  restarted.host_zero = kStart + 40s;
  restarted.sensor_zero = 0s;
  restarted.run(same, 10ms);
  EXPECT_EQ(mapping.state().steps, 1U);
  EXPECT_FALSE(mapping.state().locked);
  EXPECT_EQ(restarted.error(mapping, restarted.now()), 0ns);
}

TEST(ClockMapping, SensorThatJumpsForwardIsFollowedAtOnce) {
  Simulation line;
  line.mean_delay = 0ns;
  ClockMapping<ImuTime> mapping;
  line.run(mapping, 30s);
  line.sensor_zero += 10min;
  line.run(mapping, 10ms);
  EXPECT_EQ(mapping.state().steps, 1U);
  EXPECT_EQ(line.error(mapping, line.now()), 0ns);
}

// An MTi with GNSS stamps some messages 40 to 50 ms older than their neighbours (MTi notes, section
// 3).
TEST(ClockMapping, SampleTimesThatGoBackAreNotARestart) {
  Simulation line;
  line.mean_delay = 0ns;
  ClockMapping<ImuTime> mapping;
  for (int i = 0; i < 300; ++i) {
    line.run(mapping, 250ms);
    mapping.observe(line.now() - 50ms, line.truth(line.now()));
  }
  EXPECT_EQ(mapping.state().steps, 0U);
  EXPECT_EQ(line.error(mapping, line.now()), 0ns);
}

TEST(ClockMapping, SkewIsHeldThroughALongSilence) {
  Simulation line;
  line.skew_ppm = 40.0;
  line.mean_delay = 0ns;
  ClockMapping<ImuTime> mapping;
  line.run(mapping, 100s);
  const ImuTime later = line.now() + 10min;
  EXPECT_LT(std::chrono::abs(line.error(mapping, later)), 50us);
}

TEST(ClockMapping, SameInputGivesTheSameBits) {
  const auto run = [] {
    Simulation line;
    line.skew_ppm = 33.0;
    line.batch = 16ms;
    ClockMapping<ImuTime> mapping;
    line.run(mapping, 100s);
    return mapping.to_host(line.now());
  };
  EXPECT_EQ(run(), run());
}

TEST(ClockMapping, ResetForgetsEverything) {
  Simulation line;
  line.skew_ppm = 33.0;
  ClockMapping<ImuTime> mapping;
  line.run(mapping, 30s);
  mapping.reset();
  EXPECT_EQ(mapping.state().samples, 0U);
  EXPECT_EQ(mapping.state().skew_ppm, 0.0);
  EXPECT_FALSE(mapping.state().locked);
}

}  // namespace
}  // namespace convexcut
