// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/scan/scan.hpp"
#include "core/time.hpp"

namespace convexcut::daemon {

// How one scan went, as published with it. Totals count from the start of the daemon.
struct ScanStatus {
  HostTime stamp{};  // of the scan
  std::uint64_t index = 0;
  ScanEnd end = ScanEnd::cut;
  bool late = false;  // published after the constant latency
  std::uint32_t points = 0;
  std::uint32_t structure_points = 0;
  std::uint32_t dropped_no_orientation = 0;
  std::uint32_t overflow_returns = 0;
  double coverage = 0.0;  // 0 … 1
  Duration latency{};     // last firing → return of the DDS write of the structure
  std::uint64_t late_scans_total = 0;
  std::uint64_t lost_packets_total = 0;      // lidar datagrams that never came
  std::uint64_t rejected_packets_total = 0;  // that came and were not a lidar's
  std::uint64_t lost_imu_samples_total = 0;
  std::uint64_t ring_overruns_total = 0;
  std::uint64_t publish_timeouts_total = 0;
  std::uint8_t effort = 0;  // Effort: 0 is full, see docs/ros2.md
  std::uint64_t reduced_scans_total = 0;
};

}  // namespace convexcut::daemon
