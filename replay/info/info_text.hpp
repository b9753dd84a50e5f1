// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/clock/clock_mapping.hpp"
#include "core/time.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {

[[nodiscard]] double per_second(std::uint64_t count, Duration span);

// How the host's and a sensor's clock go together, for `info`.
[[nodiscard]] JsonObject clock_json(const ClockState& clock);
void print_clock(const ClockState& clock);

}  // namespace convexcut::replay
