// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/wire.hpp"
#include "drivers/xsens/xbus.hpp"

namespace convexcut::xsens {

inline constexpr std::size_t kMaxShortFrame = kHeaderSize + kExtendedLength - 1 + kChecksumSize;

// Writes a whole frame at the front of `out` and returns its size. Preconditions: at most 254
// bytes of payload, room for it, and no overlap. RT.
inline std::size_t write_frame(MessageId message, wire::Bytes payload,
                               wire::WritableBytes out) noexcept {
  const std::size_t size = kHeaderSize + payload.size() + kChecksumSize;
  assert(payload.size() < kExtendedLength && size <= out.size());
  out[kPreambleOffset] = std::byte{kPreamble};
  out[kBusIdOffset] = std::byte{kBusId};
  out[kMessageIdOffset] = static_cast<std::byte>(message);
  out[kLengthOffset] = static_cast<std::byte>(payload.size());
  std::ranges::copy(payload, out.begin() + kHeaderSize);
  out[size - 1] = checksum(out.first(size));
  return size;
}

// The same, allocating: not for the receive thread.
[[nodiscard]] inline std::vector<std::byte> make_frame(MessageId message,
                                                       wire::Bytes payload = {}) {
  std::array<std::byte, kMaxShortFrame> frame;
  const std::size_t size = write_frame(message, payload, frame);
  return {frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size)};
}

}  // namespace convexcut::xsens
