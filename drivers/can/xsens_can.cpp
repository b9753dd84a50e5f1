// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/xsens_can.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>

#include "drivers/wire.hpp"

namespace convexcut::can {
namespace {

using wire::Bytes;
using xsens::MtItem;
using xsens::Reals;

// Scales. Quaternions: 1/32767 by the protocol documentation and Xsens' own driver, where the DBC
// file has 2^-15; normalising removes the difference.
constexpr double kUnitQuaternion = 1.0 / 32767.0;
constexpr double kEulerDeg = 0x1p-7;
constexpr double kRateOfTurn = 0x1p-9;
constexpr double kAcceleration = 0x1p-8;
constexpr double kMagneticField = 0x1p-10;
constexpr double kTemperature = 0x1p-8;
constexpr double kBaroPressure = 0x1p-15;
constexpr double kLatitude = 0x1p-24;
constexpr double kLongitude = 0x1p-23;
constexpr double kAltitude = 0x1p-15;
constexpr double kEcef = 0x1p-8;
constexpr double kVelocity = 0x1p-6;
constexpr double kDop = 0.01;

constexpr std::size_t kDeltaVExponentOffset = 6;
constexpr std::size_t kLatitudeOffset = 0;
constexpr std::size_t kLongitudeOffset = 4;

constexpr std::size_t kUtcYearOffset = 0;
constexpr std::size_t kUtcMonthOffset = 1;
constexpr std::size_t kUtcDayOffset = 2;
constexpr std::size_t kUtcHourOffset = 3;
constexpr std::size_t kUtcMinuteOffset = 4;
constexpr std::size_t kUtcSecondOffset = 5;
constexpr std::size_t kUtcTenthMillisecondsOffset = 6;

constexpr std::array<std::uint8_t, kXsensMessageCount> kLengths = {
    1, 1, 4, 2, 8, 4, 8, 6, 7, 6, 8, 6, 6, 6, 2, 4, 6, 6, 8, 4, 4, 4, 4, 6, 5, 8};
static_assert(static_cast<std::size_t>(XsensMessage::gnss_receiver_dop) + 1 == kXsensMessageCount);
static_assert(std::ranges::all_of(kLengths, [](auto n) { return n <= kMaxClassicLength; }));

template <std::integral Raw = std::int16_t, std::size_t N>
void scaled(Bytes data, double scale, Reals<N>& out) noexcept {
  for (std::size_t i = 0; i < N; ++i) out[i] = scale * wire::load_be<Raw>(data, i * sizeof(Raw));
}

xsens::UtcTime utc(Bytes data) noexcept {
  constexpr std::uint32_t kNsPerTenthMillisecond = 100'000;
  constexpr std::uint16_t kPivot = 70;  // two digits of the year: 70 … 99 are 19xx
  xsens::UtcTime time;
  const std::uint16_t year = wire::load_u8(data, kUtcYearOffset);
  time.year = static_cast<std::uint16_t>(year + (year < kPivot ? 2000 : 1900));
  time.month = wire::load_u8(data, kUtcMonthOffset);
  time.day = wire::load_u8(data, kUtcDayOffset);
  time.hour = wire::load_u8(data, kUtcHourOffset);
  time.minute = wire::load_u8(data, kUtcMinuteOffset);
  time.second = wire::load_u8(data, kUtcSecondOffset);
  time.nanosecond =
      wire::load_be<std::uint16_t>(data, kUtcTenthMillisecondsOffset) * kNsPerTenthMillisecond;
  return time;
}

void lat_lon(Bytes data, Reals<2>& out) noexcept {
  out = {kLatitude * wire::load_be<std::int32_t>(data, kLatitudeOffset),
         kLongitude * wire::load_be<std::int32_t>(data, kLongitudeOffset)};
}

// One axis a frame; the position is there when all three are.
void ecef(XsensMessage axis, Bytes data, XsensCanData& out) noexcept {
  const auto index =
      static_cast<std::size_t>(axis) - static_cast<std::size_t>(XsensMessage::position_ecef_x);
  out.measurement.position_ecef_m[index] = kEcef * wire::load_be<std::int32_t>(data, 0);
  if (out.has(XsensMessage::position_ecef_x) && out.has(XsensMessage::position_ecef_y) &&
      out.has(XsensMessage::position_ecef_z)) {
    out.measurement.add(MtItem::position_ecef);
  }
}

GnssReceiverStatus gnss_status(Bytes data) noexcept {
  return {wire::load_u8(data, 0), wire::load_u8(data, 1), wire::load_u8(data, 2),
          wire::load_u8(data, 3), wire::load_u8(data, 4)};
}

GnssReceiverDop gnss_dop(Bytes data) noexcept {
  Reals<4> ptvh{};
  scaled<std::uint16_t>(data, kDop, ptvh);
  return {ptvh[0], ptvh[1], ptvh[2], ptvh[3]};
}

// Time, identity and health.
void decode_header(XsensMessage message, Bytes data, XsensCanData& out) noexcept {
  xsens::MtMeasurement& m = out.measurement;
  switch (message) {
    case XsensMessage::error:
      out.error = wire::load_u8(data, 0);
      return;
    case XsensMessage::warning:
      out.warning = wire::load_u8(data, 0);
      return;
    case XsensMessage::sample_time:
      out.sample_time_us = wire::load_be<std::uint32_t>(data, 0);
      return;
    case XsensMessage::group_counter:
      m.packet_counter = wire::load_be<std::uint16_t>(data, 0);
      return m.add(MtItem::packet_counter);
    case XsensMessage::utc_time:
      m.utc = utc(data);
      return m.add(MtItem::utc_time);
    case XsensMessage::status_word:
      m.status_word = wire::load_be<std::uint32_t>(data, 0);
      return m.add(MtItem::status_word);
    default:
      return;
  }
}

void decode_inertial(XsensMessage message, Bytes data, xsens::MtMeasurement& m) noexcept {
  switch (message) {
    case XsensMessage::quaternion:
      scaled(data, kUnitQuaternion, m.quaternion.value);
      return m.add(MtItem::quaternion);
    case XsensMessage::euler_angles:
      scaled(data, kEulerDeg, m.euler_deg.value);
      return m.add(MtItem::euler_angles);
    case XsensMessage::delta_v:
      // The scale is in the frame; the DBC file's fixed 2^-17 holds at 400 Hz only.
      scaled(data, std::ldexp(1.0, -wire::load_u8(data, kDeltaVExponentOffset)), m.delta_v_m_s);
      return m.add(MtItem::delta_v);
    case XsensMessage::rate_of_turn:
      scaled(data, kRateOfTurn, m.rate_of_turn_rad_s);
      return m.add(MtItem::rate_of_turn);
    case XsensMessage::delta_q:
      scaled(data, kUnitQuaternion, m.delta_q);
      return m.add(MtItem::delta_q);
    case XsensMessage::acceleration:
      scaled(data, kAcceleration, m.acceleration_m_s2);
      return m.add(MtItem::acceleration);
    case XsensMessage::free_acceleration:
      scaled(data, kAcceleration, m.free_acceleration_m_s2);
      return m.add(MtItem::free_acceleration);
    case XsensMessage::rate_of_turn_hr:
      scaled(data, kRateOfTurn, m.rate_of_turn_hr_rad_s);
      return m.add(MtItem::rate_of_turn_hr);
    case XsensMessage::acceleration_hr:
      scaled(data, kAcceleration, m.acceleration_hr_m_s2);
      return m.add(MtItem::acceleration_hr);
    default:
      return;
  }
}

void decode_environment(XsensMessage message, Bytes data, XsensCanData& out) noexcept {
  xsens::MtMeasurement& m = out.measurement;
  switch (message) {
    case XsensMessage::magnetic_field:
      scaled(data, kMagneticField, m.magnetic_field);
      return m.add(MtItem::magnetic_field);
    case XsensMessage::temperature:
      scaled(data, kTemperature, m.temperature_c);
      return m.add(MtItem::temperature);
    case XsensMessage::baro_pressure:
      // Unsigned: an atmosphere times 2^15 does not fit into 31 bits.
      m.baro_pressure_pa = kBaroPressure * wire::load_be<std::uint32_t>(data, 0);
      return m.add(MtItem::baro_pressure);
    case XsensMessage::lat_lon:
      lat_lon(data, m.lat_lon_deg);
      return m.add(MtItem::lat_lon);
    case XsensMessage::altitude_ellipsoid:
      scaled<std::int32_t>(data, kAltitude, m.altitude_ellipsoid_m);
      return m.add(MtItem::altitude_ellipsoid);
    case XsensMessage::position_ecef_x:
    case XsensMessage::position_ecef_y:
    case XsensMessage::position_ecef_z:
      return ecef(message, data, out);
    case XsensMessage::velocity:
      scaled(data, kVelocity, m.velocity_m_s.value);
      return m.add(MtItem::velocity);
    case XsensMessage::gnss_receiver_status:
      out.gnss_status = gnss_status(data);
      return;
    case XsensMessage::gnss_receiver_dop:
      out.gnss_dop = gnss_dop(data);
      return;
    default:
      return;
  }
}

}  // namespace

std::size_t expected_length(XsensMessage message) noexcept {
  return kLengths[static_cast<std::size_t>(message)];
}

std::optional<XsensMessage> XsensCanIds::find(const CanFrame& frame) const noexcept {
  if (frame.remote || frame.error || frame.fd || frame.extended != extended) return std::nullopt;
  const auto found = std::find(ids.begin(), ids.end(), frame.id);
  if (found == ids.end()) return std::nullopt;
  return static_cast<XsensMessage>(found - ids.begin());
}

bool decode_xsens(XsensMessage message, const CanFrame& frame, XsensCanData& data) noexcept {
  const Bytes payload = frame.payload();
  if (payload.size() < expected_length(message)) return false;
  data.messages |= XsensCanData::bit(message);
  decode_header(message, payload, data);
  decode_inertial(message, payload, data.measurement);
  decode_environment(message, payload, data);
  return true;
}

}  // namespace convexcut::can
