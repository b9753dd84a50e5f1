// SPDX-License-Identifier: Apache-2.0
//
// Health messages through DDS within one process. That ROS's tools show them is taken from the
// definition of diagnostic_msgs, not tried.
#include "daemon/dds/health_publisher.hpp"

#include <cerrno>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "support/test_domain.hpp"
#include "support/test_reader.hpp"
#include "tests/daemon/health/made_up_snapshot.hpp"

namespace convexcut::daemon {
namespace {

using testing::made_up_snapshot;
using testing::ros2_default_qos;
using testing::TestReader;
using Health = convexcut_msg_dds__Health_;
using DiagnosticArray = diagnostic_msgs_msg_dds__DiagnosticArray_;

class HealthPublisherTest : public ::testing::Test {
 protected:
  config::Dds settings_ = testing::test_settings();
  Participant participant_{settings_};
  HealthPublisher publisher_{participant_, settings_};
};

void expect_made_up(const Health& got) {
  EXPECT_EQ(got.stamp.sec, 1'700'000'000);
  EXPECT_EQ(got.stamp.nanosec, 500'000'000U);
  EXPECT_EQ(got.uptime_ns, 90'500'000'000);
  EXPECT_EQ(got.state, 3);
  ASSERT_EQ(got.reasons._length, 2U);
  EXPECT_STREQ(got.reasons._buffer[0], "imu absent");
  EXPECT_STREQ(got.reasons._buffer[1], "results late");
  ASSERT_EQ(got.sources._length, 2U);
  const auto& lidar = got.sources._buffer[0];
  EXPECT_STREQ(lidar.name, "lidar");
  EXPECT_EQ(lidar.state, 2);
  EXPECT_TRUE(lidar.required);
  EXPECT_EQ(lidar.silence_ns, 1'000'000);
  EXPECT_EQ(lidar.valid_hz, 1808.0);
  EXPECT_EQ(lidar.valid_total, 162'720U);
  EXPECT_EQ(lidar.invalid_total, 3U);
  EXPECT_EQ(lidar.lost_total, 12U);
  const auto& imu = got.sources._buffer[1];
  EXPECT_EQ(imu.state, 0);
  EXPECT_EQ(imu.silence_ns, -1);
  EXPECT_EQ(imu.last_error, ENODEV);
  ASSERT_EQ(got.clocks._length, 1U);
  EXPECT_EQ(got.clocks._buffer[0].source, 2);
  EXPECT_TRUE(got.clocks._buffer[0].locked);
  EXPECT_EQ(got.clocks._buffer[0].offset_ns, 1'500'000'000);
  EXPECT_EQ(got.clocks._buffer[0].skew_ppm, -12.5);
  ASSERT_EQ(got.stages._length, kStages.size());
  const auto& latency = got.stages._buffer[static_cast<std::size_t>(Stage::latency)];
  EXPECT_STREQ(latency.name, "latency");
  EXPECT_EQ(latency.count, 900U);
  EXPECT_EQ(latency.p999_ns, 11'000'000);
  ASSERT_EQ(got.totals._length, kHealthCounters.size());
  EXPECT_STREQ(got.totals._buffer[0].name, "results");
  EXPECT_EQ(got.totals._buffer[0].value, 900U);
}

TEST_F(HealthPublisherTest, HealthArrivesAsItWasFilled) {
  TestReader reader(participant_, kHealthType, "rt/convexcut/health", ros2_default_qos().get());
  publisher_.publish(made_up_snapshot());
  EXPECT_TRUE(reader.take<Health>(expect_made_up));
}

TEST_F(HealthPublisherTest, ASecondMessageHasNothingOfTheFirst) {
  TestReader reader(participant_, kHealthType, "rt/convexcut/health", ros2_default_qos().get());
  publisher_.publish(made_up_snapshot());
  publisher_.publish(HealthSnapshot{});
  EXPECT_TRUE(reader.take<Health>(expect_made_up));
  EXPECT_TRUE(reader.take<Health>([](const Health& got) {
    EXPECT_EQ(got.state, 0);
    EXPECT_EQ(got.reasons._length, 0U);
    EXPECT_EQ(got.sources._length, 0U);
    EXPECT_EQ(got.clocks._length, 0U);
    EXPECT_EQ(got.totals._length, kHealthCounters.size());
  }));
}

TEST(HealthMessage, BecomesASnapshotAgain) {
  HealthMessage message;
  const HealthSnapshot sent = made_up_snapshot();
  const HealthSnapshot got = snapshot_of(message.fill(sent));
  EXPECT_EQ(got.stamp, sent.stamp);
  EXPECT_EQ(joined(got.reasons), joined(sent.reasons));
  HealthMessage again;
  const Health& second = again.fill(got);
  expect_made_up(second);
}

TEST(HealthMessage, WhatIsUnknownHereIsFaultyOrLeftOut) {
  HealthMessage filled;
  Health message = filled.fill(made_up_snapshot());
  message.state = 200;
  message.sources._buffer[0].state = 77;
  message.clocks._buffer[0].source = 9;
  std::string unknown = "new_in_a_later_version";
  message.totals._buffer[0].name = unknown.data();
  message.stages._buffer[0].name = unknown.data();
  const HealthSnapshot got = snapshot_of(message);
  EXPECT_EQ(got.state, DaemonState::faulty);
  EXPECT_EQ(got.sources[0].state, SourceState::faulty);
  EXPECT_EQ(got.clocks[0].health.source, TimeSource::none);
  EXPECT_EQ(got.totals.results, 0U);
}

std::map<std::string, std::string> values_of(
    const diagnostic_msgs_msg_dds__DiagnosticStatus_& status) {
  std::map<std::string, std::string> values;
  for (std::uint32_t i = 0; i < status.values._length; ++i) {
    values[status.values._buffer[i].key] = status.values._buffer[i].value;
  }
  return values;
}

TEST_F(HealthPublisherTest, DiagnosticsHaveTheDaemonAndEverySource) {
  TestReader reader(participant_, kDiagnosticArrayType, "rt/diagnostics", ros2_default_qos().get());
  publisher_.publish(made_up_snapshot());
  ASSERT_TRUE(reader.take<DiagnosticArray>([](const DiagnosticArray& got) {
    EXPECT_EQ(got.header.stamp.sec, 1'700'000'000);
    ASSERT_EQ(got.status._length, 3U);
    const auto& daemon = got.status._buffer[0];
    EXPECT_EQ(daemon.level, 2);
    EXPECT_STREQ(daemon.name, "convexcut: daemon");
    EXPECT_STREQ(daemon.message, "faulty: imu absent; results late");
    EXPECT_EQ(values_of(daemon).at("latency_p99_ms"), "10.400");
    EXPECT_EQ(values_of(daemon).at("late_results"), "2");
    const auto& lidar = got.status._buffer[1];
    EXPECT_EQ(lidar.level, 0);
    EXPECT_STREQ(lidar.name, "convexcut: lidar");
    EXPECT_STREQ(lidar.message, "streaming");
    EXPECT_STREQ(lidar.hardware_id, "lidar");
    EXPECT_EQ(values_of(lidar).at("valid_hz"), "1808.0");
    EXPECT_EQ(values_of(lidar).at("time_source"), "envelope");
    const auto& imu = got.status._buffer[2];
    EXPECT_EQ(imu.level, 2);
    EXPECT_STREQ(imu.message, "absent: No such device");
  }));
}

TEST_F(HealthPublisherTest, ASourceThatMayStillComeIsAWarning) {
  TestReader reader(participant_, kDiagnosticArrayType, "rt/diagnostics", ros2_default_qos().get());
  HealthSnapshot snapshot = made_up_snapshot();
  snapshot.state = DaemonState::starting;
  publisher_.publish(snapshot);
  ASSERT_TRUE(reader.take<DiagnosticArray>([](const DiagnosticArray& got) {
    EXPECT_EQ(got.status._buffer[0].level, 1);
    EXPECT_EQ(got.status._buffer[2].level, 1);
  }));
}

TEST_F(HealthPublisherTest, WithoutReadersNothingIsSent) {
  publisher_.publish(made_up_snapshot());
  EXPECT_EQ(publisher_.health().sent(), 0U);
  EXPECT_EQ(publisher_.diagnostics().sent(), 0U);
}

}  // namespace
}  // namespace convexcut::daemon
