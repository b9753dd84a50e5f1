// SPDX-License-Identifier: Apache-2.0
//
// Rotations and rigid transforms between named frames (lidar, imu, level). The frames are in the
// names: q_level_from_imu takes a vector in imu and gives it in level; p_lidar is a point in lidar.
#pragma once

#include <Eigen/Geometry>

#include "core/angle.hpp"

namespace convexcut {

using Vec3f = Eigen::Vector3f;
using Vec3 = Eigen::Vector3d;
using Quaternion = Eigen::Quaterniond;  // constructor order w, x, y, z

// Roll about x, then pitch about y, then yaw about z, all about fixed axes: R =
// Rz(yaw)·Ry(pitch)·Rx(roll). The convention of REP-103 and of the configuration's roll/pitch/yaw
// keys.
struct RollPitchYaw {
  Degrees roll;
  Degrees pitch;
  Degrees yaw;
};

[[nodiscard]] inline Quaternion to_quaternion(const RollPitchYaw& rpy) {
  return Quaternion(Eigen::AngleAxisd(rpy.yaw.to_radians().value, Vec3::UnitZ()) *
                    Eigen::AngleAxisd(rpy.pitch.to_radians().value, Vec3::UnitY()) *
                    Eigen::AngleAxisd(rpy.roll.to_radians().value, Vec3::UnitX()));
}

// p_to = rotation · p_from + translation (metres).
struct RigidTransform {
  Quaternion rotation = Quaternion::Identity();
  Vec3 translation = Vec3::Zero();

  [[nodiscard]] Vec3 operator*(const Vec3& p_from) const { return rotation * p_from + translation; }
  // a_from_b * b_from_c = a_from_c
  [[nodiscard]] RigidTransform operator*(const RigidTransform& inner) const {
    return {rotation * inner.rotation, *this * inner.translation};
  }
  [[nodiscard]] RigidTransform inverse() const {
    const Quaternion back = rotation.conjugate();
    return {back, back * -translation};
  }
};

}  // namespace convexcut
