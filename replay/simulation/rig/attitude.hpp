// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/angle.hpp"
#include "core/geometry.hpp"

namespace convexcut::simulation {

// Roll, pitch and yaw as in core/geometry.hpp, R = Rz(yaw)·Ry(pitch)·Rx(roll), and how fast each
// changes.
struct Attitude {
  Radians roll, pitch, yaw;
  double roll_rad_s = 0.0;
  double pitch_rad_s = 0.0;
  double yaw_rad_s = 0.0;
};

// The same bits on every machine, unlike to_quaternion().
[[nodiscard]] Quaternion rotation(const Attitude& attitude) noexcept;

// The rates about the axes of the rotated body.
[[nodiscard]] Vec3 body_rates_rad_s(const Attitude& attitude) noexcept;

}  // namespace convexcut::simulation
