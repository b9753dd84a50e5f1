// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/position_packet.hpp"

#include <cstddef>
#include <string_view>

namespace convexcut::velodyne {
namespace {

using namespace wire_layout;

// Scales: HDL-32E manual, figure B2.
constexpr float kDegPerSecondPerCount = 0.09766F;
constexpr float kCelsiusPerCount = 0.1453F;
constexpr float kCelsiusAtZero = 25.0F;
constexpr float kGPerCount = 0.001221F;

// A motion word: bits 15 … 12 say what it is, bits 11 … 0 are its value in two's complement.
constexpr unsigned kTagGyro = 0;
constexpr unsigned kTagTemperature = 1;
constexpr unsigned kTagAccelX = 2;
constexpr unsigned kTagAccelY = 3;

std::optional<float> motion_value(wire::Bytes payload, std::size_t at, unsigned tag) noexcept {
  const auto word = wire::load_le<std::uint16_t>(payload, at);
  if (static_cast<unsigned>(word >> 12U) != tag) return std::nullopt;
  const int value = word & 0x0FFF;
  return static_cast<float>(value < 0x800 ? value : value - 0x1000);
}

std::optional<MotionSensor> motion_sensor(wire::Bytes payload, std::size_t at) noexcept {
  const auto gyro = motion_value(payload, at + kMotionGyro, kTagGyro);
  const auto temperature = motion_value(payload, at + kMotionTemperature, kTagTemperature);
  const auto accel_x = motion_value(payload, at + kMotionAccelX, kTagAccelX);
  const auto accel_y = motion_value(payload, at + kMotionAccelY, kTagAccelY);
  if (!gyro || !temperature || !accel_x || !accel_y) return std::nullopt;
  return MotionSensor{.rate_deg_s = *gyro * kDegPerSecondPerCount,
                      .temperature_c = *temperature * kCelsiusPerCount + kCelsiusAtZero,
                      .acceleration_x_g = *accel_x * kGPerCount,
                      .acceleration_y_g = *accel_y * kGPerCount};
}

PpsState pps_state(std::uint8_t byte) noexcept {
  constexpr auto kLast = static_cast<std::uint8_t>(PpsState::error);
  return byte <= kLast ? static_cast<PpsState>(byte) : PpsState::unknown;
}

}  // namespace

PositionStatus decode_position_packet(wire::Bytes payload, PositionPacket& out) noexcept {
  if (payload.size() != kPositionPacketSize) return PositionStatus::wrong_length;
  const std::uint8_t first = wire::load_u8(payload, kNmea);
  if (first != '$' && first != 0) return PositionStatus::no_sentence;
  const auto micros = wire::load_le<std::uint32_t>(payload, kPositionTimestamp);
  if (micros > kMaxTimestamp) return PositionStatus::timestamp_out_of_range;

  PositionPacket packet;
  packet.time = {micros % kMicrosPerHour};
  packet.pps = pps_state(wire::load_u8(payload, kPpsState));
  for (std::size_t i = 0; i < kMotionSets; ++i) {
    packet.motion[i] = motion_sensor(payload, kMotion + i * kMotionSetSize);
  }
  const wire::Bytes text = payload.subspan(kNmea, kNmeaSize);
  packet.nmea_status = parse_nmea(
      std::string_view(reinterpret_cast<const char*>(text.data()), text.size()), packet.fix);
  out = packet;
  return PositionStatus::ok;
}

}  // namespace convexcut::velodyne
