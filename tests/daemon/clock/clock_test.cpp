// SPDX-License-Identifier: Apache-2.0
//
// The clocks that the daemon waits on. Does not set the host's own clock: a step of it is one of
// the reading. Does not prove that waits end soon after their time.
#include <thread>

#include <gtest/gtest.h>

#include "daemon/clock/live_clock.hpp"
#include "daemon/clock/playback_clock.hpp"

namespace convexcut::daemon {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using Steady = Clock::Steady;

std::atomic<Duration> offset_read{};
Duration read_offset() noexcept { return offset_read; }
void change_offset(Duration by) { offset_read = offset_read.load() + by; }

class LiveClockTest : public ::testing::Test {
 protected:
  LiveClockTest() { offset_read = Duration{hours{24}}; }

  std::atomic<bool> stop{false};
};

TEST_F(LiveClockTest, IsTheMonotonicClockPlusTheOffset) {
  const LiveClock clock(stop, &read_offset);
  const Steady::time_point steady = Steady::now();
  EXPECT_EQ(clock.host_at(steady).time_since_epoch(), steady.time_since_epoch() + hours{24});
  EXPECT_EQ(clock.steady_at(clock.host_at(steady)), steady);
}

TEST_F(LiveClockTest, AStepIsFollowedWhenItIsTakenAndTakenOnce) {
  LiveClock clock(stop, &read_offset);
  for (const Duration step : {Duration{hours{1}}, Duration{hours{-1}}, Duration{milliseconds{5}},
                              Duration{milliseconds{-5}}}) {
    change_offset(step);
    const HostTime before = clock.host_at(Steady::time_point{});
    EXPECT_EQ(clock.take_step(), step);
    EXPECT_EQ(clock.host_at(Steady::time_point{}), before + step);
    EXPECT_EQ(clock.take_step(), Duration::zero());
  }
  EXPECT_EQ(clock.steps(), 4U);
}

TEST_F(LiveClockTest, ASmallChangeIsFollowedAndIsNoStep) {
  LiveClock clock(stop, &read_offset);
  change_offset(milliseconds{4});
  EXPECT_EQ(clock.take_step(), Duration::zero());
  EXPECT_EQ(clock.host_at(Steady::time_point{}).time_since_epoch(), hours{24} + milliseconds{4});
  EXPECT_EQ(clock.steps(), 0U);
}

TEST_F(LiveClockTest, TheErrorOfAReadingIsNotFollowed) {
  LiveClock clock(stop, &read_offset);
  change_offset(microseconds{10});
  EXPECT_EQ(clock.take_step(), Duration::zero());
  EXPECT_EQ(clock.host_at(Steady::time_point{}).time_since_epoch(), hours{24});
}

TEST_F(LiveClockTest, TheHostsOwnOffsetIsReadTheSameTwice) {
  const Duration difference = LiveClock::read_offset() - LiveClock::read_offset();
  EXPECT_LT(std::chrono::abs(difference), milliseconds{5});
}

TEST_F(LiveClockTest, AWaitEndsNotBeforeItsTimeThoughTheClockIsSet) {
  LiveClock clock(stop, &read_offset);
  const Steady::time_point due = Steady::now() + milliseconds{20};
  std::thread setter([&] {
    change_offset(hours{1});
    static_cast<void>(clock.take_step());
  });
  clock.wait_until(due);
  EXPECT_GE(Steady::now(), due);
  setter.join();
}

TEST_F(LiveClockTest, AStopEndsAWait) {
  const LiveClock clock(stop, &read_offset);
  const Steady::time_point due = Steady::now() + hours{1};
  std::thread waiting([&] { clock.wait_until(due); });
  stop = true;
  waiting.join();
  EXPECT_LT(Steady::now(), due);
}

TEST_F(LiveClockTest, APastTimeIsNotWaitedFor) {
  stop = false;
  const LiveClock clock(stop, &read_offset);
  const Steady::time_point begun = Steady::now();
  clock.wait_until(clock.now() - hours{1});
  clock.wait_until(Steady::time_point{});
  EXPECT_LT(Steady::now() - begun, hours{1});
}

TEST(PlaybackClock, RunsThroughTheRecordingAtItsRate) {
  std::atomic<bool> stop{false};
  PlaybackClock clock(4.0, stop);
  constexpr HostTime kFirst = from_ns<HostTime>(1'700'000'000'000'000'000);
  clock.start(kFirst);
  const Steady::time_point start = clock.steady_at(kFirst);
  EXPECT_EQ(clock.steady_at(kFirst + milliseconds{400}) - start, milliseconds{100});
  EXPECT_EQ(clock.host_at(start + milliseconds{100}) - kFirst, milliseconds{400});
  clock.wait_until(kFirst + milliseconds{40});
  EXPECT_GE(clock.now(), kFirst + milliseconds{40});
}

TEST(PlaybackClock, AtRateMaxItStandsAtTheNewestStampAndNobodyWaits) {
  std::atomic<bool> stop{false};
  PlaybackClock clock(0.0, stop);
  constexpr HostTime kFirst = from_ns<HostTime>(1'700'000'000'000'000'000);
  clock.start(kFirst);
  clock.delivered(kFirst + milliseconds{7});
  clock.delivered(kFirst + milliseconds{3});
  EXPECT_FALSE(clock.paced());
  EXPECT_EQ(clock.now(), kFirst + milliseconds{7});
  clock.wait_until(kFirst + hours{1});
}

}  // namespace
}  // namespace convexcut::daemon
