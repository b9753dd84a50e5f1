// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that the links report the truth, nor that anybody calls often enough.
#include "daemon/health/source_health.hpp"

#include <cerrno>
#include <string>

#include <gtest/gtest.h>

#include "daemon/health/source_counts.hpp"

namespace convexcut::daemon {
namespace {

using live::LinkState;
using std::chrono::milliseconds;

constexpr SourceLimits kSourceLimits;

// Observations of an open link, named by what comes over it.
SourceObservation observed(LinkState link, int error = 0) {
  SourceObservation now;
  now.link = link;
  now.last_error = error;
  return now;
}
SourceObservation nothing_yet() { return observed(LinkState::open); }
SourceObservation valid_for(Duration span) {
  SourceObservation now = observed(LinkState::open);
  now.since_valid = Duration::zero();
  now.valid_for = span;
  now.valid_hz = 100.0;
  return now;
}
SourceObservation silent_for(Duration span) {
  SourceObservation now = observed(LinkState::open);
  now.since_valid = span;
  return now;
}
SourceObservation with_invalid(SourceObservation now, double valid_hz, double invalid_hz) {
  now.valid_hz = valid_hz;
  now.invalid_hz = invalid_hz;
  return now;
}

struct Case {
  std::string what;
  SourceObservation now;
  // From absent, waiting, streaming, stale, faulty.
  SourceState expected[kSourceStates];
};

TEST(SourceState, EveryTransition) {
  using enum SourceState;
  const SourceObservation steady = valid_for(kSourceLimits.recover_after);
  const SourceObservation brief = valid_for(kSourceLimits.recover_after - Duration{1});
  const Case cases[] = {
      {"link closed", observed(LinkState::closed), {absent, absent, absent, absent, absent}},
      {"no such device",
       observed(LinkState::closed, ENODEV),
       {absent, absent, absent, absent, absent}},
      {"interface down",
       observed(LinkState::closed, ENETDOWN),
       {absent, absent, absent, absent, absent}},
      {"port in use",
       observed(LinkState::closed, EADDRINUSE),
       {faulty, faulty, faulty, faulty, faulty}},
      {"no permission",
       observed(LinkState::closed, EACCES),
       {faulty, faulty, faulty, faulty, faulty}},
      {"bus off", observed(LinkState::error), {faulty, faulty, faulty, faulty, faulty}},
      {"open, nothing ever", nothing_yet(), {waiting, waiting, stale, stale, waiting}},
      {"open, silent for just too long",
       silent_for(kSourceLimits.stale_after + Duration{1}),
       {waiting, waiting, stale, stale, waiting}},
      {"open, silent for not too long",
       silent_for(kSourceLimits.stale_after),
       {streaming, streaming, streaming, stale, faulty}},
      {"valid, not for long", brief, {streaming, streaming, streaming, stale, faulty}},
      {"valid for long", steady, {streaming, streaming, streaming, streaming, streaming}},
      {"all invalid",
       with_invalid(nothing_yet(), 0.0, 100.0),
       {faulty, faulty, faulty, faulty, faulty}},
      {"little more than half invalid",
       with_invalid(steady, 100.0, 101.0),
       {faulty, faulty, faulty, faulty, faulty}},
      {"half invalid: only a faulty source stays so",
       with_invalid(steady, 100.0, 100.0),
       {streaming, streaming, streaming, streaming, faulty}},
      {"a ninth invalid: no longer faulty",
       with_invalid(steady, 90.0, 10.0),
       {streaming, streaming, streaming, streaming, streaming}},
      {"a little more than a ninth",
       with_invalid(steady, 89.0, 10.0),
       {streaming, streaming, streaming, streaming, faulty}},
      {"rare invalid input and nothing else",
       with_invalid(nothing_yet(), 0.0, 4.9),
       {waiting, waiting, stale, stale, waiting}},
  };
  for (const Case& c : cases) {
    for (int before = 0; before < kSourceStates; ++before) {
      const auto from = static_cast<SourceState>(before);
      EXPECT_EQ(name_of(next_state(from, c.now, kSourceLimits)), name_of(c.expected[before]))
          << c.what << ", from " << name_of(from);
    }
  }
}

// A source that is polled every 20 ms, with time that the test makes.
class SourceMonitored : public ::testing::Test {
 protected:
  // Lets `span` pass with so many inputs a second; the state then.
  SourceState run(Duration span, double valid_hz, double invalid_hz = 0.0) {
    for (const SteadyTime end = now_ + span; now_ < end;) {
      now_ += kPoll;
      valid_ += valid_hz * 0.02;
      invalid_ += invalid_hz * 0.02;
      reading_.valid = static_cast<std::uint64_t>(valid_);
      reading_.invalid = static_cast<std::uint64_t>(invalid_);
      monitor_.update(reading_, now_);
    }
    return monitor_.health().state;
  }

  static constexpr Duration kPoll = milliseconds{20};
  SourceMonitor monitor_{"lidar", true};
  SourceReading reading_;
  SteadyTime now_{};
  double valid_ = 0.0;
  double invalid_ = 0.0;
};

TEST_F(SourceMonitored, LidarThatIsSwitchedOnLaterUnpluggedAndPluggedInAgain) {
  using enum SourceState;
  EXPECT_EQ(run(milliseconds{100}, 0.0), absent);
  reading_.link = LinkState::open;
  EXPECT_EQ(run(milliseconds{30'000}, 0.0), waiting);
  EXPECT_EQ(run(milliseconds{20}, 1808.0), streaming);
  EXPECT_EQ(run(milliseconds{5'000}, 1808.0), streaming);
  EXPECT_EQ(run(milliseconds{300}, 0.0), streaming);
  EXPECT_EQ(run(milliseconds{20}, 0.0), stale);
  reading_.link = LinkState::closed;
  EXPECT_EQ(run(milliseconds{20}, 0.0), absent);
  reading_.link = LinkState::open;
  EXPECT_EQ(run(milliseconds{20}, 0.0), waiting);
  EXPECT_EQ(run(milliseconds{40}, 1808.0), streaming);
}

TEST_F(SourceMonitored, AGapEndsOnlyWhenInputHasBeenThereForASecond) {
  using enum SourceState;
  reading_.link = LinkState::open;
  run(milliseconds{2'000}, 100.0);
  EXPECT_EQ(run(milliseconds{400}, 0.0), stale);
  EXPECT_EQ(run(milliseconds{980}, 100.0), stale);
  EXPECT_EQ(run(milliseconds{60}, 100.0), streaming);
}

TEST_F(SourceMonitored, ASourceThatStuttersStaysStaleAndDoesNotFlicker) {
  using enum SourceState;
  reading_.link = LinkState::open;
  run(milliseconds{2'000}, 100.0);
  run(milliseconds{400}, 0.0);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(run(milliseconds{500}, 100.0), stale);
    EXPECT_EQ(run(milliseconds{400}, 0.0), stale);
  }
}

TEST_F(SourceMonitored, NoiseOnTheLineIsFaultyUntilItStops) {
  using enum SourceState;
  reading_.link = LinkState::open;
  EXPECT_EQ(run(milliseconds{2'000}, 0.0, 400.0), faulty);
  EXPECT_EQ(run(milliseconds{2'500}, 100.0, 0.0), streaming);
}

TEST_F(SourceMonitored, RatesAreThoseOfTheLastSecond) {
  reading_.link = LinkState::open;
  run(milliseconds{5'000}, 1808.0, 3.0);
  EXPECT_NEAR(monitor_.health().valid_hz, 1808.0, 2.0);
  EXPECT_NEAR(monitor_.health().invalid_hz, 3.0, 1.5);
  reading_.lost += 50;
  run(milliseconds{1'000}, 1808.0);  // ends exactly one window
  EXPECT_NEAR(monitor_.health().lost_hz, 50.0, 1.0);
  EXPECT_EQ(monitor_.health().since_valid, Duration::zero());
}

TEST(SourceReading, LidarPacketsThatAreNoneAreInvalid) {
  velodyne::LidarCounters counters;
  counters.data_packets.add(10);
  counters.position_packets.add(3);
  counters.wrong_length.add(2);
  counters.foreign.add(1);
  const SourceReading reading = reading_of(counters);
  EXPECT_EQ(reading.valid, 10U);
  EXPECT_EQ(reading.invalid, 3U);
}

TEST(SourceReading, BytesInNoMessageWeighAsMuchAsMessages) {
  xsens::ImuCounters counters;
  counters.samples.add(7);
  counters.lost_messages.add(2);
  counters.xbus.skipped_bytes.add(11'520);  // a second at 115200 bit/s
  const SourceReading reading = reading_of(counters);
  EXPECT_EQ(reading.valid, 7U);
  EXPECT_EQ(reading.lost, 2U);
  EXPECT_GT(reading.invalid, 100U);
}

TEST(SourceReading, FramesOfOtherDevicesOnTheBusAreNotInvalid) {
  can::CanImuCounters counters;
  counters.samples.add(5);
  counters.foreign_frames.add(1000);
  counters.short_frames.add(1);
  counters.lost_groups.add(4);
  const SourceReading reading = reading_of(counters);
  EXPECT_EQ(reading.valid, 5U);
  EXPECT_EQ(reading.invalid, 1U);
  EXPECT_EQ(reading.lost, 4U);
}

}  // namespace
}  // namespace convexcut::daemon
