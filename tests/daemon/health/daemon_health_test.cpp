// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that the counters and states it is given are right.
#include "daemon/health/daemon_health.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace convexcut::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum DaemonState;

constexpr DaemonLimits kLimits;

TEST(DaemonState, EveryTransition) {
  struct Case {
    const char* what;
    DaemonObservation now;
    DaemonState expected[kDaemonStates];  // from starting, ok, degraded, faulty
  };
  const Duration calm = kLimits.recover_after;
  const Duration restless = kLimits.recover_after - Duration{1};
  const std::optional<Severity> none;
  const Case cases[] = {
      {"nothing wrong, sources missing at the start", {true, none, calm}, {starting, ok, ok, ok}},
      {"something small wrong at the start",
       {true, Severity::degraded, calm},
       {starting, degraded, degraded, degraded}},
      {"something serious wrong at the start",
       {true, Severity::faulty, calm},
       {faulty, faulty, faulty, faulty}},
      {"nothing wrong", {false, none, calm}, {ok, ok, ok, ok}},
      {"nothing wrong, not for long", {false, none, restless}, {ok, ok, degraded, faulty}},
      {"small", {false, Severity::degraded, calm}, {degraded, degraded, degraded, degraded}},
      {"small, not for long",
       {false, Severity::degraded, restless},
       {degraded, degraded, degraded, faulty}},
      {"serious", {false, Severity::faulty, restless}, {faulty, faulty, faulty, faulty}},
  };
  for (const Case& c : cases) {
    for (int before = 0; before < kDaemonStates; ++before) {
      const auto from = static_cast<DaemonState>(before);
      EXPECT_EQ(name_of(next_state(from, c.now, kLimits)), name_of(c.expected[before]))
          << c.what << ", from " << name_of(from);
    }
  }
}

// A daemon with a lidar and an IMU that it needs and a CAN bus that it does not, polled every 20 ms
// of the test's time.
class DaemonMonitored : public ::testing::Test {
 protected:
  DaemonMonitored() : sources_(3) {
    const char* const names[] = {"lidar", "imu", "can"};
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      sources_[i].name = names[i];
      sources_[i].required = i < 2;
      sources_[i].state = SourceState::streaming;
      sources_[i].valid_hz = 1000.0;
    }
  }

  DaemonState run(Duration span) {
    for (const SteadyTime end = now_ + span; now_ < end;) {
      now_ += milliseconds{20};
      if (publishing_) ++totals_.results;
      monitor_.update(sources_, totals_, others_, now_);
    }
    return monitor_.state();
  }
  [[nodiscard]] std::vector<std::string> reasons() const {
    std::vector<std::string> texts;
    for (const Reason& reason : monitor_.reasons()) texts.push_back(reason.text);
    return texts;
  }
  [[nodiscard]] std::string joined() const {
    std::string all;
    for (const std::string& text : reasons()) all += text;
    return all;
  }
  void set_all(SourceState state) {
    for (SourceHealth& source : sources_) source.state = state;
  }

  std::vector<SourceHealth> sources_;
  HealthCounters totals_;
  std::vector<Reason> others_;
  bool publishing_ = true;
  DaemonMonitor monitor_;
  SteadyTime now_{seconds{1000}};
};

TEST_F(DaemonMonitored, IsOkWhenEverythingStreams) {
  EXPECT_EQ(run(milliseconds{20}), ok);
  EXPECT_EQ(run(seconds{100}), ok);
  EXPECT_THAT(reasons(), IsEmpty());
}

TEST_F(DaemonMonitored, WaitsForSourcesAtTheStartAndSaysForWhich) {
  set_all(SourceState::waiting);
  EXPECT_EQ(run(seconds{5}), starting);
  EXPECT_THAT(reasons(), ElementsAre("lidar waiting", "imu waiting", "can waiting"));
  set_all(SourceState::streaming);
  EXPECT_EQ(run(milliseconds{20}), ok);
}

TEST_F(DaemonMonitored, IsFaultyWhenARequiredSourceIsNotThereAfterTheGrace) {
  set_all(SourceState::absent);
  run(kLimits.start_grace);
  EXPECT_EQ(run(milliseconds{40}), faulty);
  EXPECT_THAT(reasons(), ElementsAre("lidar absent", "imu absent", "can absent"));
}

TEST_F(DaemonMonitored, TheGraceIsForTheStartOnly) {
  EXPECT_EQ(run(milliseconds{20}), ok);
  sources_[0].state = SourceState::absent;
  EXPECT_EQ(run(milliseconds{20}), faulty);
}

TEST_F(DaemonMonitored, AFaultySourceIsToldAtOnceAlsoAtTheStart) {
  set_all(SourceState::waiting);
  run(seconds{1});
  sources_[0].state = SourceState::faulty;
  EXPECT_EQ(run(milliseconds{20}), faulty);
  EXPECT_THAT(reasons(), ElementsAre("lidar faulty", "imu waiting", "can waiting"));
}

TEST_F(DaemonMonitored, ASourceThatIsNotNeededOnlyDegrades) {
  run(seconds{1});
  sources_[2].state = SourceState::stale;
  EXPECT_EQ(run(milliseconds{20}), degraded);
  EXPECT_THAT(reasons(), ElementsAre("can stale"));
}

TEST_F(DaemonMonitored, GoodNewsHaveToLastAndKeepTheReasonUntilThen) {
  run(seconds{1});
  sources_[1].state = SourceState::stale;
  run(milliseconds{20});
  sources_[1].state = SourceState::streaming;
  EXPECT_EQ(run(kLimits.recover_after - milliseconds{20}), faulty);
  EXPECT_THAT(reasons(), ElementsAre("imu stale"));
  EXPECT_EQ(run(milliseconds{20}), ok);
  EXPECT_THAT(reasons(), IsEmpty());
}

TEST_F(DaemonMonitored, NoResultsForASecondAreAFault) {
  run(seconds{1});
  publishing_ = false;
  EXPECT_EQ(run(kLimits.silent_after), ok);
  EXPECT_EQ(run(milliseconds{20}), faulty);
  EXPECT_THAT(reasons(), ElementsAre("no results published"));
  publishing_ = true;
  EXPECT_EQ(run(seconds{3}), ok);
}

TEST_F(DaemonMonitored, EveryLossDegradesForAWhile) {
  run(seconds{1});
  for (const CounterInfo& counter : kHealthCounters) {
    totals_.*counter.value += 1;
    const DaemonState expected = counter.loss.empty() ? ok : degraded;
    EXPECT_EQ(run(milliseconds{20}), expected) << counter.name;
    EXPECT_EQ(joined(), counter.loss);
    EXPECT_EQ(run(kLimits.loss_hold), expected) << counter.name;
    EXPECT_EQ(run(kLimits.recover_after + milliseconds{20}), ok) << counter.name;
  }
}

TEST_F(DaemonMonitored, WhatWasCountedBeforeTheFirstLookIsNoLoss) {
  totals_.late_results = 7;
  EXPECT_EQ(run(seconds{1}), ok);
}

TEST_F(DaemonMonitored, MoreThanAHundredthOfTheInputMissingDegrades) {
  run(seconds{1});
  sources_[0].lost_hz = 10.0;  // of 1010
  EXPECT_EQ(run(seconds{1}), ok);
  sources_[0].lost_hz = 10.2;
  EXPECT_EQ(run(seconds{1}), degraded);
  EXPECT_THAT(reasons(), ElementsAre("lidar losing input"));
}

TEST_F(DaemonMonitored, WorstReasonsComeFirst) {
  run(seconds{1});
  others_ = {{Severity::degraded, "memory not locked"}, {Severity::faulty, "something serious"}};
  sources_[2].state = SourceState::stale;
  EXPECT_EQ(run(milliseconds{20}), faulty);
  EXPECT_THAT(reasons(), ElementsAre("something serious", "can stale", "memory not locked"));
}

}  // namespace
}  // namespace convexcut::daemon
