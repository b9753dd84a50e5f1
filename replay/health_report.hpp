// SPDX-License-Identifier: Apache-2.0
//
// A daemon's health, for people and for programs.
#pragma once

#include <optional>
#include <string>

#include "daemon/health/snapshot.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {

// "degraded: results late", or only "ok".
[[nodiscard]] std::string state_and_reasons(const daemon::HealthSnapshot& health);

// Lines: the states, the percentiles of every stage that was passed, what has been counted.
[[nodiscard]] std::string health_block(const daemon::HealthSnapshot& health);

[[nodiscard]] JsonObject health_json(const daemon::HealthSnapshot& health);

// Tells when the states of the daemon or its sources are no longer those of the last call.
class HealthStates {
 public:
  [[nodiscard]] bool changed(const daemon::HealthSnapshot& health);

 private:
  std::optional<std::string> last_;
};

}  // namespace convexcut::replay
