// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>

#include "daemon/health/snapshot.hpp"

namespace convexcut::daemon::testing {

// A daemon whose IMU has gone away, with something in every field.
inline HealthSnapshot made_up_snapshot() {
  using std::chrono::microseconds;
  using std::chrono::milliseconds;
  HealthSnapshot snapshot;
  snapshot.stamp = from_ns<HostTime>(1'700'000'000'500'000'000);
  snapshot.uptime = std::chrono::milliseconds{90'500};
  snapshot.state = DaemonState::faulty;
  snapshot.reasons = {{Severity::faulty, "imu absent"}, {Severity::degraded, "results late"}};
  SourceHealth lidar;
  lidar.name = "lidar";
  lidar.required = true;
  lidar.state = SourceState::streaming;
  lidar.reading = {live::LinkState::open, 0, 162'720, 3, 12};
  lidar.since_valid = milliseconds{1};
  lidar.valid_hz = 1808.0;
  lidar.invalid_hz = 0.5;
  SourceHealth imu;
  imu.name = "imu";
  imu.required = true;
  imu.state = SourceState::absent;
  imu.reading = {live::LinkState::closed, ENODEV, 0, 0, 0};
  snapshot.sources = {lidar, imu};
  ClockHealth clock;
  clock.source = TimeSource::envelope;
  clock.locked = true;
  clock.offset = milliseconds{1500};
  clock.jitter = microseconds{80};
  clock.skew_ppm = -12.5;
  clock.steps = 1;
  snapshot.clocks = {{"lidar", clock}};
  snapshot.stages[static_cast<std::size_t>(Stage::latency)] = {900,
                                                               milliseconds{9045},
                                                               milliseconds{10},
                                                               microseconds{10'400},
                                                               milliseconds{11},
                                                               milliseconds{12}};
  snapshot.totals.results = 900;
  snapshot.totals.late_results = 2;
  snapshot.totals.recorded_bytes = 1'000'000'000'000;
  return snapshot;
}

}  // namespace convexcut::daemon::testing
