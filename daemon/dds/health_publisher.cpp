// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/health_publisher.hpp"

#include "daemon/dds/qos.hpp"
#include "daemon/dds/topic_name.hpp"

namespace convexcut::daemon {

HealthPublisher::HealthPublisher(const Participant& participant, const config::Dds& settings)
    : health_(participant, kHealthType, kHealthTopic, message_writer_qos(settings, kHealthType)),
      diagnostics_(participant, kDiagnosticArrayType, kDiagnosticsTopic,
                   message_writer_qos(settings, kDiagnosticArrayType)) {}

void HealthPublisher::publish(const HealthSnapshot& snapshot) {
  // A write that fails is counted by its writer; the next one is a second away.
  if (health_.has_reader()) {
    static_cast<void>(health_.write(&health_message_.fill(snapshot)));
  }
  if (diagnostics_.has_reader()) {
    static_cast<void>(diagnostics_.write(&diagnostics_message_.fill(snapshot)));
  }
}

}  // namespace convexcut::daemon
