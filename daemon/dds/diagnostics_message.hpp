// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/dds/ros2.h"
#include "daemon/dds/text_pool.hpp"
#include "daemon/health/snapshot.hpp"

namespace convexcut::daemon {

// A diagnostic_msgs/DiagnosticArray, as ROS's monitors read it: one status of the daemon, one of
// each source; everything as text. Its memory is ours. One thread.
class DiagnosticsMessage {
 public:
  DiagnosticsMessage() = default;
  DiagnosticsMessage(const DiagnosticsMessage&) = delete;  // the message points into this object
  DiagnosticsMessage& operator=(const DiagnosticsMessage&) = delete;

  // Valid until the next call.
  const diagnostic_msgs_msg_dds__DiagnosticArray_& fill(const HealthSnapshot& snapshot);

 private:
  using KeyValues = std::vector<diagnostic_msgs_msg_dds__KeyValue_>;

  void add_daemon(const HealthSnapshot& snapshot);
  void add_source(const SourceHealth& source, const HealthSnapshot& snapshot);
  // `values` is the newest of values_.
  void add_status(std::uint8_t level, std::string_view name, std::string_view message);
  void add_value(std::string_view key, std::string_view value);

  TextPool texts_;
  std::vector<KeyValues> values_;  // of each status; its room is made before the first
  std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> statuses_;
  diagnostic_msgs_msg_dds__DiagnosticArray_ message_{};
};

}  // namespace convexcut::daemon
