// SPDX-License-Identifier: Apache-2.0
//
// How the rig (lidar and IMU on one plate, axes alike) moves: it turns about the vertical at a
// steady rate and leans to and fro. It does not travel. The truth of a simulation.
#pragma once

#include "core/angle.hpp"
#include "core/geometry.hpp"
#include "core/time.hpp"
#include "replay/simulation/rig/rig_state.hpp"

namespace convexcut::sim {

struct RigMotionOptions {
  Degrees tilt{5.0};              // the rig's z never leans farther than this from the vertical
  Degrees turn_per_second{12.0};  // about the vertical, counter-clockwise seen from above
};

using simulation::RigState;

class RigMotion {
 public:
  explicit RigMotion(const RigMotionOptions& options) noexcept : options_(options) {}

  [[nodiscard]] RigState state(Duration since_start) const noexcept;
  [[nodiscard]] Quaternion q_level_from_rig(Duration since_start) const noexcept;

 private:
  RigMotionOptions options_;
};

}  // namespace convexcut::sim
