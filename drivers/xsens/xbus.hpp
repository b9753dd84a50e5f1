// SPDX-License-Identifier: Apache-2.0
//
// Wire layout of Xbus, the serial protocol of Xsens MTi devices (MT Low Level Communication
// Protocol; facts and sources: docs/design/imu.md). All numbers are big-endian.
//
//   | 0xFA | BID | MID | LEN | DATA[LEN] | CS |                     LEN 0 … 254
//   | 0xFA | BID | MID | 0xFF | EXTLEN u16 | DATA[EXTLEN] | CS |    EXTLEN 255 … 2048
//
// CS makes the low byte of the sum of all bytes after the preamble zero.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.hpp"

namespace convexcut::xsens {

inline constexpr std::uint8_t kPreamble = 0xFA;
inline constexpr std::uint8_t kBusId = 0xFF;  // a stand-alone device, in both directions
inline constexpr std::uint8_t kExtendedLength = 0xFF;

inline constexpr std::size_t kPreambleOffset = 0;
inline constexpr std::size_t kBusIdOffset = 1;
inline constexpr std::size_t kMessageIdOffset = 2;
inline constexpr std::size_t kLengthOffset = 3;
inline constexpr std::size_t kExtendedLengthOffset = 4;
inline constexpr std::size_t kHeaderSize = 4;
inline constexpr std::size_t kExtendedHeaderSize = 6;
inline constexpr std::size_t kChecksumSize = 1;

inline constexpr std::size_t kMinExtendedLength = 255;
inline constexpr std::size_t kMaxPayload = 2048;
inline constexpr std::size_t kMaxFrame = kExtendedHeaderSize + kMaxPayload + kChecksumSize;

static_assert(kLengthOffset + 1 == kHeaderSize);
static_assert(kExtendedLengthOffset + sizeof(std::uint16_t) == kExtendedHeaderSize);

// The message ids that are sent and understood; any other is valid too and is skipped.
enum class MessageId : std::uint8_t {
  // From the host. The device acknowledges with the id that is one higher.
  req_device_id = 0x00,
  go_to_measurement = 0x10,
  req_firmware_revision = 0x12,
  baudrate = 0x18,  // without data a request
  req_product_code = 0x1C,
  go_to_config = 0x30,
  reset = 0x40,
  set_output_configuration = 0xC0,  // without data a request
  // From the device.
  device_id = 0x01,
  configuration = 0x0D,
  go_to_measurement_ack = 0x11,
  firmware_revision = 0x13,
  baudrate_ack = 0x19,
  product_code = 0x1D,
  go_to_config_ack = 0x31,
  mtdata_legacy = 0x32,
  mtdata2 = 0x36,
  wake_up = 0x3E,
  reset_ack = 0x41,
  error = 0x42,
  warning = 0x43,
  emts = 0x91,
  output_configuration = 0xC1,
};

// Makes the low byte of the sum of all bytes after the preamble, itself among them, zero. `frame`
// is whole but for the last byte. RT.
[[nodiscard]] inline std::byte checksum(std::span<const std::byte> frame) noexcept {
  std::uint8_t sum = 0;
  for (const std::byte b : frame.subspan(kBusIdOffset, frame.size() - kBusIdOffset - 1)) {
    sum = static_cast<std::uint8_t>(sum + static_cast<std::uint8_t>(b));
  }
  return static_cast<std::byte>(-sum);
}

// How long `bytes` take on a serial line of `baud` bit/s at ten bits a byte (8N1). Zero for baud 0:
// a transport without a line rate (USB).
[[nodiscard]] constexpr Duration line_time(std::size_t bytes, std::uint32_t baud) noexcept {
  constexpr std::int64_t kBitsPerByte = 10;
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  if (baud == 0) return Duration{0};
  return Duration{static_cast<std::int64_t>(bytes) * kBitsPerByte * kNsPerSecond / baud};
}

}  // namespace convexcut::xsens
