// SPDX-License-Identifier: Apache-2.0
//
// Does not prove anything about when lines are written: that is the caller's.
#include "daemon/health/health_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/health/made_up_snapshot.hpp"

namespace convexcut::daemon {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

std::string text_of(const HealthLine& line) {
  return log::format_line(log::Destination::plain, line.level, line.event, line.fields);
}
std::vector<std::string> texts_of(const std::vector<HealthLine>& lines) {
  std::vector<std::string> texts;
  for (const HealthLine& line : lines) texts.push_back(text_of(line));
  return texts;
}

TEST(HealthLog, SummaryIsOneLine) {
  EXPECT_EQ(text_of(summary_line(testing::made_up_snapshot())),
            "error health state=faulty reasons=\"imu absent; results late\" "
            "sources=\"lidar:streaming imu:absent\" uptime_s=90 results=900 late=2 "
            "latency_p50_ms=10 latency_p99_ms=10.4 latency_p99.9_ms=11 latency_max_ms=12\n");
}

TEST(HealthLog, DetailHasALineForEverySourceClockAndStage) {
  const std::vector<std::string> lines = texts_of(detail_lines(testing::made_up_snapshot()));
  ASSERT_EQ(lines.size(), 1 + 2 + 1 + kStages.size() + 1);
  EXPECT_THAT(lines[0], StartsWith("info health state=faulty"));
  EXPECT_EQ(lines[1],
            "info health_source name=lidar state=streaming valid=162720 invalid=3 lost=12 "
            "valid_hz=1808 invalid_hz=0.5 silent_ms=1\n");
  EXPECT_EQ(lines[2],
            "info health_source name=imu state=absent valid=0 invalid=0 lost=0 valid_hz=0 "
            "invalid_hz=0 last_error=\"No such device\"\n");
  EXPECT_EQ(lines[3],
            "info health_clock name=lidar source=envelope locked=true offset_ms=1500 "
            "jitter_ms=0.08 skew_ppm=-12.5 steps=1\n");
  EXPECT_THAT(lines[4], StartsWith("info health_stage name=arrival_to_ring count=0"));
  EXPECT_THAT(lines.back(), HasSubstr("late_results=2"));
  EXPECT_THAT(lines.back(), HasSubstr("recorded_bytes=1000000000000"));
}

TEST(HealthLog, ChangesAreToldOnceEach) {
  HealthChanges changes;
  HealthSnapshot snapshot = testing::made_up_snapshot();
  EXPECT_THAT(texts_of(changes.lines(snapshot)),
              ElementsAre("info source name=lidar state=streaming\n",
                          "info source name=imu state=absent last_error=\"No such device\"\n",
                          "error daemon state=faulty was=starting "
                          "reasons=\"imu absent; results late\"\n"));
  EXPECT_THAT(changes.lines(snapshot), IsEmpty());
  snapshot.sources[0].state = SourceState::stale;
  EXPECT_THAT(texts_of(changes.lines(snapshot)),
              ElementsAre("warning source name=lidar state=stale was=streaming\n"));
  snapshot.state = DaemonState::ok;
  snapshot.reasons.clear();
  EXPECT_THAT(texts_of(changes.lines(snapshot)), ElementsAre("info daemon state=ok was=faulty\n"));
}

TEST(HealthLog, FurtherReasonIsToldOnceUntilAllIsWell) {
  HealthChanges changes;
  HealthSnapshot snapshot = testing::made_up_snapshot();
  static_cast<void>(changes.lines(snapshot));
  const std::vector<Reason> first = snapshot.reasons;
  snapshot.reasons.push_back({Severity::degraded, "lidar losing input"});
  const auto told = ElementsAre(
      "error daemon state=faulty was=faulty "
      "reasons=\"imu absent; results late; lidar losing input\"\n");
  EXPECT_THAT(texts_of(changes.lines(snapshot)), told);
  snapshot.reasons = first;
  EXPECT_THAT(changes.lines(snapshot), IsEmpty());
  snapshot.reasons.push_back({Severity::degraded, "lidar losing input"});
  EXPECT_THAT(changes.lines(snapshot), IsEmpty());
  HealthSnapshot well = snapshot;
  well.state = DaemonState::ok;
  well.reasons.clear();
  static_cast<void>(changes.lines(well));
  EXPECT_THAT(texts_of(changes.lines(snapshot)), SizeIs(1));
}

}  // namespace
}  // namespace convexcut::daemon
