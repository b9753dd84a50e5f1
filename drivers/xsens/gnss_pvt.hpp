// SPDX-License-Identifier: Apache-2.0
//
// The GNSS position-velocity-time item (0x7010) as MTi-G-710 firmware sends it, 94 bytes. Other
// sizes exist in other firmwares and are skipped. Units are the receiver's (u-blox NAV-PVT).
#pragma once

#include <cstddef>
#include <cstdint>

#include "drivers/wire.hpp"

namespace convexcut::xsens {

struct GnssPvt {
  static constexpr std::size_t kSize = 94;

  std::uint32_t itow_ms = 0;
  std::uint16_t year = 0;
  std::uint8_t month = 0;
  std::uint8_t day = 0;
  std::uint8_t hour = 0;
  std::uint8_t minute = 0;
  std::uint8_t second = 0;
  std::uint8_t valid = 0;
  std::uint32_t time_accuracy_ns = 0;
  std::int32_t nanosecond = 0;
  std::uint8_t fix_type = 0;
  std::uint8_t flags = 0;
  std::uint8_t satellites = 0;
  std::uint8_t reserved = 0;
  std::int32_t longitude_1e7_deg = 0;
  std::int32_t latitude_1e7_deg = 0;
  std::int32_t height_ellipsoid_mm = 0;
  std::int32_t height_msl_mm = 0;
  std::uint32_t horizontal_accuracy_mm = 0;
  std::uint32_t vertical_accuracy_mm = 0;
  std::int32_t velocity_north_mm_s = 0;
  std::int32_t velocity_east_mm_s = 0;
  std::int32_t velocity_down_mm_s = 0;
  std::int32_t ground_speed_mm_s = 0;
  std::int32_t heading_of_motion_1e5_deg = 0;
  std::uint32_t speed_accuracy_mm_s = 0;
  std::uint32_t heading_accuracy_1e5_deg = 0;
  std::int32_t heading_of_vehicle_1e5_deg = 0;
  // Dilutions of precision, hundredths.
  std::uint16_t gdop = 0;
  std::uint16_t pdop = 0;
  std::uint16_t tdop = 0;
  std::uint16_t vdop = 0;
  std::uint16_t hdop = 0;
  std::uint16_t ndop = 0;
  std::uint16_t edop = 0;
};

// `data` holds GnssPvt::kSize bytes. RT.
[[nodiscard]] GnssPvt load_gnss_pvt(wire::Bytes data) noexcept;

}  // namespace convexcut::xsens
