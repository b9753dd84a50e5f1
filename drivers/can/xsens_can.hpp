// SPDX-License-Identifier: Apache-2.0
//
// The CAN output of Xsens MTi devices (MTi-600 series; MT CAN Protocol Documentation, xsens.dbc):
// classic data frames, big-endian, one quantity a frame. docs/design/imu.md lists the layouts and
// where the public sources contradict each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/can/can_frame.hpp"
#include "drivers/xsens/mt_measurement.hpp"

namespace convexcut::can {

enum class XsensMessage : std::uint8_t {
  error,
  warning,
  sample_time,
  group_counter,
  utc_time,
  status_word,
  quaternion,
  euler_angles,
  delta_v,
  rate_of_turn,
  delta_q,
  acceleration,
  free_acceleration,
  magnetic_field,
  temperature,
  baro_pressure,
  rate_of_turn_hr,
  acceleration_hr,
  lat_lon,
  altitude_ellipsoid,
  position_ecef_x,
  position_ecef_y,
  position_ecef_z,
  velocity,
  gnss_receiver_status,
  gnss_receiver_dop,
};
inline constexpr std::size_t kXsensMessageCount = 26;

// Bytes of data that each message has; more are ignored.
[[nodiscard]] std::size_t expected_length(XsensMessage message) noexcept;

// Which arbitration id carries which message. Configurable on the device, for each message; the
// defaults are its data identifiers.
struct XsensCanIds {
  std::array<std::uint32_t, kXsensMessageCount> ids = {
      0x001, 0x002, 0x005, 0x006, 0x007, 0x011, 0x021, 0x022, 0x031, 0x032, 0x033, 0x034, 0x035,
      0x041, 0x051, 0x052, 0x061, 0x062, 0x071, 0x072, 0x073, 0x074, 0x075, 0x076, 0x079, 0x07A};
  bool extended = false;  // 29-bit ids

  [[nodiscard]] std::uint32_t& operator[](XsensMessage message) noexcept {
    return ids[static_cast<std::size_t>(message)];
  }
  // What a frame is; none for ids of others, for the other id length, for remote, error and CAN FD
  // frames. RT.
  [[nodiscard]] std::optional<XsensMessage> find(const CanFrame& frame) const noexcept;
};

struct GnssReceiverStatus {
  std::uint8_t fix_type = 0;
  std::uint8_t satellites_used = 0;
  std::uint8_t flags = 0;
  std::uint8_t valid = 0;
  std::uint8_t satellites = 0;
};

// Dilutions of precision.
struct GnssReceiverDop {
  double position = 0;
  double time = 0;
  double vertical = 0;
  double horizontal = 0;
};

// What some frames of one device held. Numbers that serial has too are in `measurement`, in the
// units there (the group counter as packet_counter); orientation and velocity are taken as ENU, the
// device's default: the frames do not say.
struct XsensCanData {
  xsens::MtMeasurement measurement;
  std::uint32_t sample_time_us = 0;
  std::uint8_t error = 0;  // 1: output buffer overflow, the device dropped messages
  std::uint8_t warning = 0;
  GnssReceiverStatus gnss_status;
  GnssReceiverDop gnss_dop;
  std::uint32_t messages = 0;  // one bit each

  [[nodiscard]] static constexpr std::uint32_t bit(XsensMessage message) noexcept {
    return std::uint32_t{1} << static_cast<unsigned>(message);
  }
  [[nodiscard]] constexpr bool has(XsensMessage message) const noexcept {
    return (messages & bit(message)) != 0;
  }
};

// Adds what the frame holds to `data`; false, and no change, when it is shorter than expected. RT.
[[nodiscard]] bool decode_xsens(XsensMessage message, const CanFrame& frame,
                                XsensCanData& data) noexcept;

}  // namespace convexcut::can
