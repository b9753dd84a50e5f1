// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "config/config.hpp"
#include "daemon/dds/entity.hpp"
#include "daemon/dds/ros2_type.hpp"

namespace convexcut::daemon {

// All our writers are VOLATILE and encode plain CDR version 1; a RELIABLE one matches every ROS 2
// reader. KEEP_LAST: a slow reader loses old samples, it does not hold up the writer.

// For clouds: two, so that a lost fragment of the scan before the newest can still be asked for.
inline constexpr std::int32_t kCloudDepth = 2;
// For small messages that come often: a quarter of a second of a 400 Hz IMU.
inline constexpr std::int32_t kMessageDepth = 100;

// RELIABLE or BEST_EFFORT as configured, KEEP_LAST kCloudDepth.
[[nodiscard]] Qos cloud_writer_qos(const config::Dds& settings, const Ros2Type& type);
// RELIABLE, KEEP_LAST kMessageDepth.
[[nodiscard]] Qos message_writer_qos(const config::Dds& settings, const Ros2Type& type);

// The least a reader can ask for, so it matches any writer: BEST_EFFORT, VOLATILE, KEEP_LAST depth.
[[nodiscard]] Qos reader_qos(std::int32_t depth, const Ros2Type& type);

// "RELIABILITY", … as ROS 2's tools write it, of a policy id in an incompatible-QoS status.
[[nodiscard]] std::string_view policy_name(std::uint32_t policy_id) noexcept;

}  // namespace convexcut::daemon
