// SPDX-License-Identifier: Apache-2.0
//
// The collecting only: the judgement of what is collected is tested beside it.
#include "daemon/health/health_monitor.hpp"

#include <gtest/gtest.h>

namespace convexcut::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(HealthMonitor, SnapshotHasWhatItsPartsSaid) {
  StageHistograms stages;
  ClockGauge clock;
  HealthMonitor monitor(stages);
  SourceReading reading{live::LinkState::open, 0, 0, 0, 0};
  monitor.add_source("lidar", true, [&reading] { return reading; });
  monitor.add_clock("lidar", clock);

  const SteadyTime start{seconds{50}};
  monitor.poll(start, {});
  reading.valid = 18;
  HealthCounters totals;
  totals.results = 4;
  monitor.poll(start + milliseconds{20}, totals, {{Severity::degraded, "memory not locked"}});
  for (int i = 1; i <= 100; ++i) stages.record(Stage::level, milliseconds{i});
  ClockState state;
  state.offset = milliseconds{3};
  state.locked = true;
  clock.store(TimeSource::pps, state);

  const HealthSnapshot snapshot = monitor.snapshot(from_ns<HostTime>(7), start + seconds{2});
  EXPECT_EQ(snapshot.stamp, from_ns<HostTime>(7));
  EXPECT_EQ(snapshot.uptime, seconds{2});
  EXPECT_EQ(snapshot.state, DaemonState::degraded);
  EXPECT_EQ(joined(snapshot.reasons), "memory not locked");
  ASSERT_EQ(snapshot.sources.size(), 1U);
  EXPECT_EQ(snapshot.sources[0].state, SourceState::streaming);
  EXPECT_EQ(snapshot.sources[0].reading.valid, 18U);
  ASSERT_EQ(snapshot.clocks.size(), 1U);
  EXPECT_EQ(snapshot.clocks[0].health.source, TimeSource::pps);
  EXPECT_EQ(snapshot.clocks[0].health.offset, milliseconds{3});
  EXPECT_TRUE(snapshot.clocks[0].health.locked);
  EXPECT_EQ(snapshot.totals.results, 4U);
  const StageSummary& level = snapshot.stages[static_cast<std::size_t>(Stage::level)];
  EXPECT_EQ(level.count, 100U);
  EXPECT_EQ(level.max, milliseconds{100});
  EXPECT_NEAR(static_cast<double>(level.p50.count()), 50e6, 50e6 / 64);
  EXPECT_EQ(snapshot.stages[static_cast<std::size_t>(Stage::cut)].count, 0U);
}

TEST(HealthMonitor, ARecordingPlayedSlowlyMayBeSilentForLonger) {
  const StageHistograms stages;
  for (const double pace : {1.0, 0.05}) {
    HealthMonitor monitor(stages, pace);
    SourceReading reading{live::LinkState::open, 0, 1, 0, 0};
    monitor.add_source("lidar", true, [&reading] { return reading; });
    const SteadyTime start{seconds{50}};
    // A packet a second and a result every two seconds, 20 times slower than a lidar's revolutions.
    HealthCounters totals;
    for (int i = 0; i < 60; ++i) {
      reading.valid += i % 10 == 0 ? 1U : 0U;
      totals.results += i % 20 == 0 ? 1U : 0U;
      monitor.poll(start + i * milliseconds{100}, totals);
    }
    EXPECT_EQ(monitor.state(), pace == 1.0 ? DaemonState::faulty : DaemonState::ok) << pace;
    // Silence is silence in the end.
    monitor.poll(start + seconds{60}, totals);
    EXPECT_EQ(monitor.state(), DaemonState::faulty) << pace;
  }
}

TEST(HealthMonitor, BeforeTheFirstPollItIsStarting) {
  const StageHistograms stages;
  const HealthMonitor monitor(stages);
  const HealthSnapshot snapshot = monitor.snapshot({}, SteadyTime{seconds{9}});
  EXPECT_EQ(snapshot.state, DaemonState::starting);
  EXPECT_EQ(snapshot.uptime, Duration::zero());
}

}  // namespace
}  // namespace convexcut::daemon
