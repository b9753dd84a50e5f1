// SPDX-License-Identifier: Apache-2.0
//
// The orientation of a measurement as the rest of the system wants it: imu → level, z up.
#pragma once

#include <optional>

#include "core/geometry.hpp"
#include "drivers/xsens/mt_measurement.hpp"

namespace convexcut::xsens {

[[nodiscard]] inline bool has_orientation(const MtMeasurement& m) noexcept {
  return m.has(MtItem::quaternion) || m.has(MtItem::rotation_matrix) || m.has(MtItem::euler_angles);
}

// From the quaternion, else the rotation matrix, else the Euler angles. Unit length; empty when the
// measurement has none of them or its numbers are no rotation (not finite; a quaternion whose
// length is not within a factor of two of 1; a matrix that is not orthonormal within 0.01).
// Heading: of an ENU output zero is x towards east, and a NED output is turned into the same by
// exchanging x and y and negating z. A NWU output is z up already and is left alone: its zero is x
// towards north. RT.
[[nodiscard]] std::optional<Quaternion> q_level_from_imu(const MtMeasurement& m) noexcept;

}  // namespace convexcut::xsens
