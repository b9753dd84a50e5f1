// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/angle.hpp"
#include "replay/simulation/wire/device_clock.hpp"

namespace convexcut::simulation {

// How the simulated HDL-32E sees. docs/design/simulator.md has the formulas and their reasons.
struct LidarOptions {
  double rotor_hz = 10.0;        // 5 … 20
  Degrees start_azimuth{215.0};  // of the first firing: the first revolution is a partial one
  double noise_m = 0.02;         // standard deviation of a range
  double min_range_m = 0.3;
  double max_range_m = 100.0;
  Radians divergence{0.003};    // of the whole beam; 0: a beam is a line
  double pulse_length_m = 0.5;  // echoes that are nearer to each other than this are one
  double dropout = 0.005;       // share of the shots that are lost whatever they meet
  bool attenuation = true;      // shots are also lost for want of light
  double ghosts = 0.0;          // share of the returns that are at a range where nothing is
  bool dual = false;            // strongest and last return
  DeviceClock clock{};          // by the true clock
};

}  // namespace convexcut::simulation
