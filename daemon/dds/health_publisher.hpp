// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "config/config.hpp"
#include "daemon/dds/diagnostics_message.hpp"
#include "daemon/dds/health_message.hpp"
#include "daemon/dds/participant.hpp"
#include "daemon/dds/topic_writer.hpp"
#include "daemon/health/snapshot.hpp"

namespace convexcut::daemon {

// convexcut/msg/Health on convexcut/health and diagnostic_msgs/DiagnosticArray on diagnostics.
// One thread, not a realtime one; see publisher.hpp.
class HealthPublisher {
 public:
  // DdsError when a topic cannot be made.
  HealthPublisher(const Participant& participant, const config::Dds& settings);

  // About once a second. What nobody reads is not even built.
  void publish(const HealthSnapshot& snapshot);

  [[nodiscard]] const TopicWriter& health() const noexcept { return health_; }
  [[nodiscard]] const TopicWriter& diagnostics() const noexcept { return diagnostics_; }

 private:
  TopicWriter health_;
  TopicWriter diagnostics_;
  HealthMessage health_message_;
  DiagnosticsMessage diagnostics_message_;
};

}  // namespace convexcut::daemon
