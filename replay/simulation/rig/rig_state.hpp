// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry.hpp"
#include "core/scan/function_ref.hpp"
#include "core/time.hpp"

namespace convexcut::simulation {

inline constexpr double kGravity = 9.81;  // m/s²

// What an IMU on the rig has to measure at an instant.
struct RigState {
  Quaternion q_level_from_imu = Quaternion::Identity();
  Vec3 angular_velocity_rad_s = Vec3::Zero();  // in imu
  Vec3 specific_force_m_s2 = Vec3::Zero();     // in imu: +g upwards at rest
};

// By the time since the start of the simulation, which may be negative.
using RigStateAt = FunctionRef<RigState(Duration)>;

}  // namespace convexcut::simulation
