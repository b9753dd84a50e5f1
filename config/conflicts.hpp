// SPDX-License-Identifier: Apache-2.0
//
// Values that are right each for itself but not together.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/config.hpp"

namespace convexcut::config {

// What an IMU that is configured sends for each sample (packet counter, time, orientation, rate of
// turn, acceleration, status), which its line must be fast enough for.
inline constexpr std::uint32_t kConfiguredMessageBytes = 73;

struct Conflict {
  std::vector<std::string_view> keys;  // that take part
  std::string text;                    // "expected …, found …"
};

[[nodiscard]] std::vector<Conflict> find_conflicts(const Config& config);

// What of DDS uses one of the lidar's UDP ports, if anything does: RTPS (2.2, section 9.6.1.1)
// gives a domain the ports 7400 + 250·domain + {0, 1} and, for participant p of a host, + {10 + 2p,
// 11 + 2p}. Participants 0 … 32 of a host are considered, the most that ROS 2 sets Cyclone DDS up
// for.
[[nodiscard]] std::optional<std::string> port_collision(std::uint32_t domain,
                                                        std::uint16_t data_port,
                                                        std::uint16_t position_port);

}  // namespace convexcut::config
