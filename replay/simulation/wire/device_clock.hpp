// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/time.hpp"

namespace convexcut::simulation {

// A device's oscillator: it counts from 0 at the start of the simulation, slightly fast or slow.
struct DeviceClock {
  double fast_by_ppm = 0.0;

  // The true time, since the start, at which the device has counted `elapsed`.
  [[nodiscard]] Duration true_time(Duration elapsed) const noexcept {
    const double correction = static_cast<double>(elapsed.count()) * fast_by_ppm * 1e-6;
    return elapsed - Duration{std::llround(correction / (1.0 + fast_by_ppm * 1e-6))};
  }
};

}  // namespace convexcut::simulation
