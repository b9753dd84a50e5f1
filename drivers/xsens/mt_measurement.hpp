// SPDX-License-Identifier: Apache-2.0
//
// What one MTData2 message (or one group of CAN frames) holds, as numbers in the units of the
// device. Items that were not in the message keep their defaults; has() tells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/xsens/gnss_pvt.hpp"
#include "drivers/xsens/mt_data_id.hpp"

namespace convexcut::xsens {

enum class MtItem : std::uint8_t {
  packet_counter,
  packet_counter32,
  itow,
  sample_time_fine,
  sample_time_coarse,
  sample_time64,
  utc_time,
  temperature,
  quaternion,
  rotation_matrix,
  euler_angles,
  baro_pressure,
  delta_v,
  acceleration,
  free_acceleration,
  acceleration_hr,
  altitude_msl,
  altitude_ellipsoid,
  position_ecef,
  lat_lon,
  gnss_pvt,
  rate_of_turn,
  delta_q,
  rate_of_turn_hr,
  magnetic_field,
  velocity,
  status_byte,
  status_word,
};

struct UtcTime {
  std::uint32_t nanosecond = 0;
  std::uint16_t year = 0;
  std::uint8_t month = 0;
  std::uint8_t day = 0;
  std::uint8_t hour = 0;
  std::uint8_t minute = 0;
  std::uint8_t second = 0;
  std::uint8_t flags = 0;  // 1 time of week valid, 2 week valid, 4 UTC valid; others occur
};

template <std::size_t N>
using Reals = std::array<double, N>;

template <std::size_t N>
struct InFrame {
  Reals<N> value{};
  CoordinateSystem frame = CoordinateSystem::enu;
};

struct MtMeasurement {
  std::uint16_t packet_counter = 0;  // +1 a message, 65535 → 0
  std::uint32_t packet_counter32 = 0;
  std::uint32_t itow_ms = 0;
  std::uint32_t sample_time_fine = 0;    // ticks of 100 µs
  std::uint32_t sample_time_coarse = 0;  // s
  std::uint64_t sample_time64 = 0;
  UtcTime utc;
  Reals<1> temperature_c{};
  InFrame<4> quaternion;       // w x y z, sensor → local frame
  InFrame<9> rotation_matrix;  // sensor → local frame, column by column
  InFrame<3> euler_deg;        // roll, pitch, yaw; R = Rz(yaw)·Ry(pitch)·Rx(roll)
  double baro_pressure_pa = 0;
  Reals<3> delta_v_m_s{};             // over one output interval
  Reals<3> acceleration_m_s2{};       // specific force: +9.81 up at rest
  Reals<3> free_acceleration_m_s2{};  // local frame, without gravity
  Reals<3> acceleration_hr_m_s2{};
  Reals<1> altitude_msl_m{};
  Reals<1> altitude_ellipsoid_m{};
  Reals<3> position_ecef_m{};
  Reals<2> lat_lon_deg{};
  GnssPvt gnss_pvt;
  Reals<3> rate_of_turn_rad_s{};
  Reals<4> delta_q{};  // w x y z, over one output interval
  Reals<3> rate_of_turn_hr_rad_s{};
  Reals<3> magnetic_field{};  // 1.0 = the field at the place of calibration
  InFrame<3> velocity_m_s;
  std::uint8_t status_byte = 0;  // the low 8 bits of the status word
  std::uint32_t status_word = 0;

  [[nodiscard]] constexpr bool has(MtItem item) const noexcept { return (items & bit(item)) != 0; }
  constexpr void add(MtItem item) noexcept { items |= bit(item); }
  [[nodiscard]] static constexpr std::uint32_t bit(MtItem item) noexcept {
    return std::uint32_t{1} << static_cast<unsigned>(item);
  }

  std::uint32_t items = 0;
};
static_assert(static_cast<unsigned>(MtItem::status_word) < 32, "one presence bit an item");

}  // namespace convexcut::xsens
