// SPDX-License-Identifier: Apache-2.0
//
// How the rig (lidar and IMU on one plate, axes alike) moves: the truth of a simulation.
#pragma once

#include <array>
#include <cstdint>

#include "core/angle.hpp"
#include "core/geometry.hpp"
#include "core/time.hpp"
#include "replay/simulation/rig/attitude.hpp"
#include "replay/simulation/rig/rig_path.hpp"
#include "replay/simulation/rig/rig_state.hpp"
#include "replay/simulation/rig/sway.hpp"

namespace convexcut::simulation {

// The paper's stage, which turns the lidar about the vertical and leans it about its own y axis; a
// hand that sways; a path. All together: R = Rz(yaw)·Ry(tilt)·Rx(roll) of the lidar in the world.
struct RigOptions {
  Degrees yaw{0.0};                  // at the start
  Degrees rotation_per_second{0.0};  // about the vertical, counter-clockwise from above
  Degrees tilt{0.0};                 // about y: positive leans the lidar's x downwards
  Degrees tilt_swing{0.0};           // to both sides of the tilt
  double tilt_swing_hz = 0.1;
  Degrees sway{0.0};    // root mean square of roll, pitch and yaw each
  double sway_m = 0.0;  // root mean square of x, y and z each
  RigPath path;         // of the lidar in the world
};

struct Pose {
  Vec3 position_world = Vec3::Zero();
  Quaternion q_world_from_lidar = Quaternion::Identity();
};

class RigMotion {
 public:
  RigMotion(const RigOptions& options, std::uint64_t seed);

  // Exact and smooth; times may be negative.
  [[nodiscard]] Pose pose_at(Duration since_start) const noexcept;
  // What an ideal IMU measures: level is the world.
  [[nodiscard]] RigState state(Duration since_start) const noexcept;

 private:
  [[nodiscard]] Attitude attitude(Duration since_start) const noexcept;

  RigOptions options_;
  std::array<Sway, 3> turns_;   // roll, pitch, yaw, radians
  std::array<Sway, 3> shifts_;  // x, y, z, metres
};

}  // namespace convexcut::simulation
