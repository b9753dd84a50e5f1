// SPDX-License-Identifier: Apache-2.0
//
// Data identifiers of MTData2 items: type in bits 15 … 4, number format and coordinate system in
// bits 3 … 0 (xsdataidentifier.h of the Xsens SDK).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace convexcut::xsens {

enum class DataType : std::uint16_t {
  temperature = 0x0810,
  utc_time = 0x1010,
  packet_counter = 0x1020,
  itow = 0x1030,
  sample_time_fine = 0x1060,
  sample_time_coarse = 0x1070,
  sample_time64 = 0x10A0,
  packet_counter32 = 0x10B0,
  quaternion = 0x2010,
  rotation_matrix = 0x2020,
  euler_angles = 0x2030,
  baro_pressure = 0x3010,
  delta_v = 0x4010,
  acceleration = 0x4020,
  free_acceleration = 0x4030,
  acceleration_hr = 0x4040,
  altitude_msl = 0x5010,
  altitude_ellipsoid = 0x5020,
  position_ecef = 0x5030,
  lat_lon = 0x5040,
  gnss_pvt = 0x7010,
  rate_of_turn = 0x8020,
  delta_q = 0x8030,
  rate_of_turn_hr = 0x8040,
  magnetic_field = 0xC020,
  velocity = 0xD010,
  status_byte = 0xE010,
  status_word = 0xE020,
};

enum class NumberFormat : std::uint8_t {
  float32 = 0,
  fp12_20 = 1,  // int32 / 2^20
  fp16_32 = 2,  // int48 / 2^32, sent as 32 bits of fraction, then 16 bits of integer
  float64 = 3,
};

// The local frame that orientation and velocity refer to.
enum class CoordinateSystem : std::uint8_t { enu = 0x0, ned = 0x4, nwu = 0x8 };

inline constexpr std::uint16_t kTypeMask = 0xFFF0;
inline constexpr std::uint16_t kNumberFormatMask = 0x0003;
inline constexpr std::uint16_t kCoordinateMask = 0x000C;
inline constexpr std::uint16_t kReservedCoordinates = 0x000C;

[[nodiscard]] constexpr DataType type_of(std::uint16_t data_id) noexcept {
  return static_cast<DataType>(data_id & kTypeMask);
}
[[nodiscard]] constexpr NumberFormat number_format_of(std::uint16_t data_id) noexcept {
  return static_cast<NumberFormat>(data_id & kNumberFormatMask);
}
[[nodiscard]] constexpr CoordinateSystem coordinates_of(std::uint16_t data_id) noexcept {
  return static_cast<CoordinateSystem>(data_id & kCoordinateMask);
}
[[nodiscard]] constexpr std::size_t size_of(NumberFormat format) noexcept {
  switch (format) {
    case NumberFormat::fp16_32:
      return 6;
    case NumberFormat::float64:
      return 8;
    case NumberFormat::float32:
    case NumberFormat::fp12_20:
      break;
  }
  return 4;
}

// "Quaternion, float32, ENU" for people; "unknown" for a type that is not in the list above.
// Allocates: not for the receive thread.
[[nodiscard]] std::string describe_data_id(std::uint16_t data_id);

}  // namespace convexcut::xsens
