// SPDX-License-Identifier: Apache-2.0
#include "replay/info/info_text.hpp"

#include <cstdio>

namespace convexcut::replay {

double per_second(std::uint64_t count, Duration span) {
  return span > Duration::zero() ? static_cast<double>(count) / seconds(span) : 0.0;
}

JsonObject clock_json(const ClockState& clock) {
  return JsonObject()
      .add("offset_s", seconds(clock.offset), 6)
      .add("skew_ppm", clock.skew_ppm, 2)
      .add("jitter_us", seconds(clock.jitter) * 1e6, 1)
      .add("steps", std::uint64_t{clock.steps})
      .add("locked", clock.locked);
}

void print_clock(const ClockState& clock) {
  std::printf(
      "  clock        host - sensor %.6f s, jitter %.0f us, skew %s, %u steps\n",
      seconds(clock.offset), seconds(clock.jitter) * 1e6,
      clock.locked ? format("%.1f ppm", clock.skew_ppm).c_str() : "unknown (too short a recording)",
      clock.steps);
}

}  // namespace convexcut::replay
