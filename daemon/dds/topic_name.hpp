// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace convexcut::daemon {

// Of what the daemon says of itself; the last is ROS's own name for it. The other topics' names are
// in the configuration.
inline constexpr std::string_view kStatusTopic = "convexcut/status";
inline constexpr std::string_view kHealthTopic = "convexcut/health";
inline constexpr std::string_view kDiagnosticsTopic = "diagnostics";

// The DDS topic of a ROS 2 topic: "points" and "/points" are rt/points. DdsError unless the name is
// tokens of [A-Za-z0-9_], none starting with a digit, separated by '/' (ROS 2's rule).
[[nodiscard]] std::string dds_topic_name(std::string_view ros_name);

}  // namespace convexcut::daemon
