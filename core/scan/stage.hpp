// SPDX-License-Identifier: Apache-2.0
//
// A lidar on a stage that turns it about one of its own axes through its origin.
#pragma once

#include <cstdint>

#include "core/angle.hpp"
#include "core/geometry.hpp"

namespace convexcut {

// Right-handed, as the angles of a mount: see RollPitchYaw.
enum class StageAxis : std::uint8_t {
  rotation,  // about z, counter-clockwise seen from above
  tilt,      // about y, ahead downwards
};

// Lidar → base of the stage. At angle 0 both are the same.
[[nodiscard]] Quaternion stage_rotation(StageAxis axis, Radians angle) noexcept;

// Where the x axis of `body` points to, about z of level: the yaw of RollPitchYaw, −π … π. While x
// is vertical it says nothing, and y is taken, which points 90° further.
[[nodiscard]] Radians heading(const Quaternion& q_level_from_body) noexcept;

// The same roll and pitch with the heading of the stage instead: R = R_stage · Rz(−heading) · R.
// `q_base_from_lidar` is a rotation about z.
[[nodiscard]] Quaternion with_heading(const Quaternion& q_level_from_lidar,
                                      const Quaternion& q_base_from_lidar) noexcept;

}  // namespace convexcut
