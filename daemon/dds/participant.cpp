// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/participant.hpp"

#include <string>

namespace convexcut::daemon {

Participant::Participant(const config::Dds& settings)
    : domain_(Domain::open(settings.domain, settings.profile)),
      entity_(require(dds_create_participant(settings.domain, nullptr, nullptr),
                      "DDS domain " + std::to_string(settings.domain) + ": participant")) {}

}  // namespace convexcut::daemon
