// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that the numbers are right at the source: they are the daemon's.
#include "replay/watch_report.hpp"

#include <gtest/gtest.h>

#include "replay/health_report.hpp"
#include "tests/daemon/health/made_up_snapshot.hpp"

namespace convexcut::replay {
namespace {

using Status = convexcut_msg_dds__ScanStatus_;

constexpr Duration kSecond = std::chrono::seconds{1};

Status status_with_latency(std::int64_t ms) {
  Status status{};
  status.points = 1000;
  status.structure_points = 600;
  status.coverage = 0.5;
  status.latency_ns = ms * 1'000'000;
  return status;
}

TEST(WatchCounter, RatesAreMessagesOverTheTimeThatPassed) {
  WatchCounter counter;
  for (int i = 0; i < 10; ++i) counter.add_structure();
  for (int i = 0; i < 5; ++i) counter.add_points();
  for (int i = 0; i < 400; ++i) counter.add_imu();
  const WatchInterval interval = counter.finish(2 * kSecond);
  EXPECT_EQ(interval.structure_hz, 5.0);
  EXPECT_EQ(interval.points_hz, 2.5);
  EXPECT_EQ(interval.imu_hz, 200.0);
}

TEST(WatchCounter, EveryIntervalStartsFromZero) {
  WatchCounter counter;
  counter.add_structure();
  counter.add_status(status_with_latency(1));
  static_cast<void>(counter.finish(kSecond));
  const WatchInterval interval = counter.finish(kSecond);
  EXPECT_EQ(interval.structure_hz, 0.0);
  EXPECT_FALSE(interval.status.has_value());
}

TEST(WatchCounter, SummarisesTheScansOfTheInterval) {
  WatchCounter counter;
  for (const std::int64_t ms : {30, 10, 20}) counter.add_status(status_with_latency(ms));
  const WatchInterval interval = counter.finish(kSecond);
  ASSERT_TRUE(interval.status.has_value());
  EXPECT_EQ(interval.status->points_per_scan, 1000.0);
  EXPECT_EQ(interval.status->structure_share, 0.6);
  EXPECT_EQ(interval.status->coverage, 0.5);
  EXPECT_EQ(interval.status->latency_p50, std::chrono::milliseconds{20});
  EXPECT_EQ(interval.status->latency_max, std::chrono::milliseconds{30});
}

TEST(WatchCounter, EmptyScansHaveNoStructureShare) {
  WatchCounter counter;
  counter.add_status(Status{});
  EXPECT_EQ(counter.finish(kSecond).status->structure_share, 0.0);
}

TEST(WatchCounter, CountsLossesSinceTheIntervalBefore) {
  WatchCounter counter;
  Status status{};
  status.lost_packets_total = 100;  // before anyone watched
  counter.add_status(status);
  EXPECT_EQ(counter.finish(kSecond).status->lost_packets, 0U);
  status.lost_packets_total = 103;
  status.lost_imu_samples_total = 2;
  status.late_scans_total = 1;
  counter.add_status(status);
  const WatchInterval interval = counter.finish(kSecond);
  EXPECT_EQ(interval.status->lost_packets, 3U);
  EXPECT_EQ(interval.status->lost_imu_samples, 2U);
  EXPECT_EQ(interval.status->late_scans, 1U);
}

TEST(WatchCounter, ARestartedDaemonCountsFromZero) {
  WatchCounter counter;
  Status status{};
  status.lost_packets_total = 100;
  counter.add_status(status);
  static_cast<void>(counter.finish(kSecond));
  status.lost_packets_total = 1;
  counter.add_status(status);
  EXPECT_EQ(counter.finish(kSecond).status->lost_packets, 1U);
}

TEST(WatchCounter, RemembersWhetherAnythingCame) {
  WatchCounter counter;
  static_cast<void>(counter.finish(kSecond));
  EXPECT_FALSE(counter.anything_came());
  counter.add_imu();
  static_cast<void>(counter.finish(kSecond));
  static_cast<void>(counter.finish(kSecond));
  EXPECT_TRUE(counter.anything_came());
}

WatchInterval typical() {
  WatchInterval interval{10.0, 9.9, 100.2, {}, {}};
  interval.status = {
      69'000.0, 0.612, 0.995, std::chrono::microseconds{10'010}, std::chrono::microseconds{10'250},
      0,        3,     1};
  return interval;
}

TEST(WatchLine, ColumnsLineUpWithAndWithoutStatus) {
  const std::string with = watch_line(typical());
  const std::string without = watch_line(WatchInterval{});
  EXPECT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with[i] == '|', without[i] == '|') << i;
    EXPECT_EQ(with[i] == '|', watch_header()[i] == '|') << i;
  }
}

TEST(WatchLine, ShowsTheInterval) {
  EXPECT_EQ(watch_line(typical()),
            "     10.0     9.9   100.2 |  69000    61.2   99.5 |   10.01   10.25      0 |       3"
            "         1\n");
}

TEST(WatchJson, IsOneObjectALine) {
  EXPECT_EQ(watch_json(typical(), 4),
            "{\"publishers\": 4, \"structure_hz\": 10.00, \"points_hz\": 9.90, \"imu_hz\": 100.20, "
            "\"points_per_scan\": 69000.0, \"structure_share\": 0.6120, \"coverage\": 0.9950, "
            "\"latency_p50_ms\": 10.010, \"latency_max_ms\": 10.250, \"late_scans\": 0, "
            "\"lost_packets\": 3, \"lost_imu_samples\": 1}\n");
}

TEST(WatchJson, LeavesOutWhatTheDaemonDidNotSay) {
  EXPECT_EQ(watch_json(WatchInterval{}, 0),
            "{\"publishers\": 0, \"structure_hz\": 0.00, \"points_hz\": 0.00, \"imu_hz\": 0.00}\n");
}

TEST(WatchLine, EndsWithTheDaemonsStateWhenItIsKnown) {
  WatchInterval interval = typical();
  interval.health = daemon::testing::made_up_snapshot();
  EXPECT_TRUE(watch_line(interval).ends_with(" | faulty: imu absent; results late\n"));
  interval.health->state = daemon::DaemonState::ok;
  interval.health->reasons.clear();
  EXPECT_TRUE(watch_line(interval).ends_with(" | ok\n"));
}

TEST(WatchCounter, KeepsTheNewestHealthUntilTheDaemonIsGone) {
  WatchCounter counter;
  EXPECT_FALSE(counter.finish(kSecond).health.has_value());
  counter.set_health(daemon::testing::made_up_snapshot());
  EXPECT_TRUE(counter.finish(kSecond).health.has_value());
  EXPECT_TRUE(counter.finish(kSecond).health.has_value());
  EXPECT_TRUE(counter.anything_came());
  counter.forget_health();
  EXPECT_FALSE(counter.finish(kSecond).health.has_value());
}

TEST(HealthBlock, ShowsStatesPercentilesAndCounts) {
  EXPECT_EQ(health_block(daemon::testing::made_up_snapshot()),
            "daemon faulty: imu absent; results late, up 0:01:30\n"
            "  lidar  streaming   1808.0 Hz  162,720 valid, 3 invalid, 12 lost, time: envelope\n"
            "  imu    absent         0.0 Hz  0 valid, 0 invalid, 0 lost, No such device\n"
            "  stage                count    p50 ms    p99 ms  p99.9 ms    max ms\n"
            "  latency                900    10.000    10.400    11.000    12.000\n"
            "  results 900, late_results 2, recorded_bytes 1,000,000,000,000\n");
}

TEST(HealthBlock, OfADaemonThatHasJustStartedIsOneLine) {
  EXPECT_EQ(health_block(daemon::HealthSnapshot{}), "daemon starting, up 0:00:00\n");
}

TEST(HealthJson, HasEverything) {
  const std::string json = health_json(daemon::testing::made_up_snapshot()).text();
  for (const char* const part :
       {"{\"state\": \"faulty\", \"reasons\": \"imu absent; results late\", \"uptime_s\": 90.5, ",
        "{\"name\": \"lidar\", \"state\": \"streaming\", \"required\": true, \"valid_hz\": "
        "1808.0, ",
        "\"last_error\": \"No such device\"}",
        "{\"name\": \"lidar\", \"source\": \"envelope\", \"locked\": true, \"offset_ms\": "
        "1500.000, ",
        "{\"name\": \"latency\", \"count\": 900, \"p50_ms\": 10.000, \"p99_ms\": 10.400, "
        "\"p99.9_ms\": 11.000, \"max_ms\": 12.000}",
        "\"totals\": {\"results\": 900, \"empty_results\": 0, \"late_results\": 2, "}) {
    EXPECT_NE(json.find(part), std::string::npos) << part << "\nin " << json;
  }
}

TEST(HealthStates, ChangeWithAStateAndNotWithANumber) {
  HealthStates states;
  daemon::HealthSnapshot health = daemon::testing::made_up_snapshot();
  EXPECT_TRUE(states.changed(health));
  health.totals.results += 10;
  health.uptime += kSecond;
  EXPECT_FALSE(states.changed(health));
  health.sources[0].state = daemon::SourceState::stale;
  EXPECT_TRUE(states.changed(health));
  EXPECT_FALSE(states.changed(health));
}

}  // namespace
}  // namespace convexcut::replay
