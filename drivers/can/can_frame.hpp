// SPDX-License-Identifier: Apache-2.0
//
// One CAN frame, whatever it came from: a socket, a capture or a log.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.hpp"

namespace convexcut::can {

inline constexpr std::uint32_t kMaxStandardId = 0x7FF;
inline constexpr std::uint32_t kMaxExtendedId = 0x1FFFFFFF;
inline constexpr std::size_t kMaxClassicLength = 8;
inline constexpr std::size_t kMaxFdLength = 64;

// An arbitration identifier: 11 bits, or 29 when extended. The two kinds share no messages.
struct CanId {
  std::uint32_t id = 0;
  bool extended = false;
  friend constexpr bool operator==(const CanId&, const CanId&) = default;
};

struct CanFrame {
  HostTime stamp{};         // when the host had received the frame
  std::uint32_t id = 0;     // 11 or 29 bits; the error class bits of an error frame
  bool extended = false;    // 29-bit id
  bool remote = false;      // a request, without data
  bool error = false;       // not from the bus: the controller's report
  bool fd = false;          // CAN FD
  std::uint8_t length = 0;  // bytes of data: 0 … 8, FD up to 64; 0 for remote frames
  std::array<std::byte, kMaxFdLength> data{};

  [[nodiscard]] std::span<const std::byte> payload() const noexcept {
    return std::span<const std::byte>(data).first(length);
  }
};

// Whether a device that sends with this identifier sent the frame.
[[nodiscard]] constexpr bool has_id(const CanFrame& frame, const CanId& id) noexcept {
  return !frame.error && frame.id == id.id && frame.extended == id.extended;
}

// Whether a frame can have so many bytes of data. CAN FD has no lengths between those of its DLC.
[[nodiscard]] constexpr bool is_valid_length(std::size_t length, bool fd) noexcept {
  if (length <= kMaxClassicLength) return true;
  if (!fd || length > kMaxFdLength) return false;
  if (length <= 24) return length % 4 == 0;
  return length == 32 || length == 48 || length == 64;
}

// The least time that the frame was on the bus: start of frame to end of frame, without stuff bits
// (44 bits around the data with an 11-bit id, 64 with a 29-bit one; ISO 11898-1). Zero for bit rate
// 0. CAN FD frames are taken at the arbitration rate throughout.
[[nodiscard]] constexpr Duration bus_time(const CanFrame& frame, std::uint32_t bitrate) noexcept {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  if (bitrate == 0) return Duration{0};
  const std::int64_t bits = (frame.extended ? 64 : 44) + 8 * std::int64_t{frame.length};
  return Duration{bits * kNsPerSecond / bitrate};
}

}  // namespace convexcut::can
