// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "config/config.hpp"
#include "daemon/dds/entity.hpp"
#include "daemon/dds/ros2_type.hpp"

namespace convexcut::daemon {

// Two: the scan being sent and the one before it, so that a reader that lost a fragment can still
// ask for it again.
inline constexpr std::int32_t kHistoryDepth = 2;

// What our writers offer: RELIABLE (matches every ROS 2 reader) or BEST_EFFORT, VOLATILE,
// KEEP_LAST 2, plain CDR version 1.
[[nodiscard]] Qos writer_qos(const config::Dds& settings, const Ros2Type& type);

// The least a reader can ask for, so it matches any writer: BEST_EFFORT, VOLATILE, KEEP_LAST depth.
[[nodiscard]] Qos reader_qos(std::int32_t depth, const Ros2Type& type);

// "RELIABILITY", … as ROS 2's tools write it, of a policy id in an incompatible-QoS status.
[[nodiscard]] std::string_view policy_name(std::uint32_t policy_id) noexcept;

}  // namespace convexcut::daemon
