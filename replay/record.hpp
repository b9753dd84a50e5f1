// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "config/config.hpp"
#include "core/time.hpp"

namespace convexcut::replay {

struct RecordOptions {
  config::Config config;             // its record.directory is where to
  std::optional<Duration> duration;  // not given: until SIGINT or SIGTERM
  bool json = false;                 // the closing counts as one JSON object
};

// Records the live sources without computing anything from them: lidar_000.pcap, imu_000.pcap …,
// with a line of progress on stderr and counts on stdout. Gives 0, or 1 when nothing was recorded
// or something is missing. Throws capture::CaptureError, config::ConfigError, std::system_error.
[[nodiscard]] int record(const RecordOptions& options);

}  // namespace convexcut::replay
