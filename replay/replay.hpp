// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "config/config.hpp"
#include "daemon/sources/recordings.hpp"
#include "replay/feed/player.hpp"

namespace convexcut::replay {

struct ReplayOptions {
  daemon::RecordingPaths recordings;  // at least one
  config::Config config;
  PlayerOptions player;
  std::string to_address = "127.0.0.1";
  std::uint16_t data_port = 0;      // 0: the configuration's
  std::uint16_t position_port = 0;  // 0: the configuration's
  std::filesystem::path imu_link;   // to the IMU's terminal; empty: none
  std::string can_interface;
  std::uint64_t seed = 1;
  bool json = false;
};

// Feeds live inputs with recordings as the sensors would, and prints what was sent. Blocks SIGINT
// and SIGTERM and ends cleanly on them. Throws what the parts throw: one line each.
void replay(const ReplayOptions& options);

}  // namespace convexcut::replay
