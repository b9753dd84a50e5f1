// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/time.hpp"
#include "daemon/dds/ros2.h"

namespace convexcut::daemon {

// builtin_interfaces/Time counts 0 … 999 999 999 ns up from a second that may be negative. Exact
// until 2038, when its int32 seconds end.
[[nodiscard]] inline builtin_interfaces_msg_dds__Time_ to_ros2_time(HostTime time) noexcept {
  const auto second = std::chrono::floor<std::chrono::seconds>(time);
  return {static_cast<std::int32_t>(second.time_since_epoch().count()),
          static_cast<std::uint32_t>((time - second).count())};
}

}  // namespace convexcut::daemon
