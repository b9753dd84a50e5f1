// SPDX-License-Identifier: Apache-2.0
//
// Checked against the published grammar, not by a Prometheus server.
#include "daemon/health/prometheus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/health/exposition_checker.hpp"
#include "tests/daemon/health/made_up_snapshot.hpp"

namespace convexcut::daemon {
namespace {

using ::testing::IsSupersetOf;
using ::testing::Pair;

TEST(PrometheusText, IsTheFormatAndHasTheNumbers) {
  const auto samples = testing::read_exposition(prometheus_text(testing::made_up_snapshot()));
  EXPECT_THAT(samples,
              IsSupersetOf({
                  Pair("convexcut_state{state=\"faulty\"}", "1"),
                  Pair("convexcut_state{state=\"ok\"}", "0"),
                  Pair("convexcut_uptime_seconds", "90.5"),
                  Pair("convexcut_source_state{source=\"lidar\",state=\"streaming\"}", "1"),
                  Pair("convexcut_source_state{source=\"imu\",state=\"streaming\"}", "0"),
                  Pair("convexcut_source_state{source=\"imu\",state=\"absent\"}", "1"),
                  Pair("convexcut_source_silence_seconds{source=\"lidar\"}", "0.001"),
                  Pair("convexcut_source_silence_seconds{source=\"imu\"}", "+Inf"),
                  Pair("convexcut_source_valid_total{source=\"lidar\"}", "162720"),
                  Pair("convexcut_source_lost_total{source=\"lidar\"}", "12"),
                  Pair("convexcut_clock_source{source=\"lidar\",time=\"envelope\"}", "1"),
                  Pair("convexcut_clock_offset_seconds{source=\"lidar\"}", "1.5"),
                  Pair("convexcut_clock_skew_ratio{source=\"lidar\"}", "-1.25e-05"),
                  Pair("convexcut_stage_seconds{stage=\"latency\",quantile=\"0.99\"}", "0.0104"),
                  Pair("convexcut_stage_seconds_count{stage=\"latency\"}", "900"),
                  Pair("convexcut_stage_seconds_sum{stage=\"latency\"}", "9.045"),
                  Pair("convexcut_stage_seconds{stage=\"level\",quantile=\"0.5\"}", "NaN"),
                  Pair("convexcut_stage_max_seconds{stage=\"latency\"}", "0.012"),
                  Pair("convexcut_results_total", "900"),
                  Pair("convexcut_recorded_bytes_total", "1000000000000"),
              }));
}

TEST(PrometheusText, IsTheFormatWithoutSourcesAndClocksToo) {
  const auto samples = testing::read_exposition(prometheus_text(HealthSnapshot{}));
  EXPECT_THAT(samples, IsSupersetOf({Pair("convexcut_state{state=\"starting\"}", "1")}));
}

TEST(PrometheusText, EscapesWhatALabelCannotHold) {
  HealthSnapshot snapshot = testing::made_up_snapshot();
  snapshot.sources[0].name = "a\"b\\c\nd";
  const auto samples = testing::read_exposition(prometheus_text(snapshot));
  EXPECT_THAT(
      samples,
      IsSupersetOf({Pair(R"(convexcut_source_valid_total{source="a\"b\\c\nd"})", "162720")}));
}

}  // namespace
}  // namespace convexcut::daemon
