// SPDX-License-Identifier: Apache-2.0
//
// One IMU sample, whatever it came over (Xbus serial or CAN): the only IMU type past the drivers.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry.hpp"
#include "core/time.hpp"

namespace convexcut {

struct ImuSample {
  // Earliest instant at which the host can have had the whole sample: the stamp of its last byte
  // (or of the frame) less the time the bytes took on the line.
  HostTime arrival{};
  // The device's own time of the sample. Not monotonic on every device: never assume it.
  ImuTime device_time{};

  // Rotation imu → level: level is z up with the heading that the IMU gives (a NED output is turned
  // to z up by the driver). Unit length.
  Quaternion q_level_from_imu = Quaternion::Identity();
  Vec3f angular_velocity_rad_s = Vec3f::Zero();  // in imu
  Vec3f acceleration_m_s2 = Vec3f::Zero();       // in imu, specific force: +9.81 up at rest
  std::uint32_t status = 0;                      // MTi StatusWord, 0 when absent
  std::uint16_t counter = 0;                     // PacketCounter / GroupCounter, wraps

  // What the message held; the fields of absent items keep their defaults.
  bool has_device_time = false;
  bool has_orientation = false;
  bool has_angular_velocity = false;
  bool has_acceleration = false;
  bool has_status = false;
  bool has_counter = false;
};

}  // namespace convexcut
