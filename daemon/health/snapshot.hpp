// SPDX-License-Identifier: Apache-2.0
//
// The daemon's health at one moment, as plain data. Its forms: log lines (health_log.hpp),
// Prometheus text (prometheus.hpp), DDS messages (daemon/dds/health_message.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "daemon/health/clock_gauge.hpp"
#include "daemon/health/counters.hpp"
#include "daemon/health/daemon_health.hpp"
#include "daemon/health/source_health.hpp"
#include "daemon/health/stages.hpp"

namespace convexcut::daemon {

struct StageSummary {
  std::uint64_t count = 0;
  Duration total{};
  Duration p50{};
  Duration p99{};
  Duration p999{};
  Duration max{};
};

[[nodiscard]] StageSummary summary_of(const LatencyHistogram& histogram) noexcept;

struct SensorClock {
  std::string name;  // of the sensor
  ClockHealth health;
};

struct HealthSnapshot {
  HostTime stamp{};
  Duration uptime{};
  DaemonState state = DaemonState::starting;
  std::vector<Reason> reasons;
  std::vector<SourceHealth> sources;
  std::vector<SensorClock> clocks;
  std::array<StageSummary, kStages.size()> stages;  // in the order of kStages
  HealthCounters totals;
};

// "lidar stale; results late", or nothing.
[[nodiscard]] std::string joined(const std::vector<Reason>& reasons);

}  // namespace convexcut::daemon
