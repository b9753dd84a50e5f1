// SPDX-License-Identifier: Apache-2.0
//
// What an MTi is told to send: packet counter and sample time with every message, orientation,
// acceleration and rate of turn at one rate, and the status.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/wire.hpp"
#include "drivers/xsens/mt_data_id.hpp"
#include "drivers/xsens/mtdata2.hpp"
#include "drivers/xsens/xbus.hpp"

namespace convexcut::xsens {

// SetOutputConfiguration: a list of | data id u16 | rate u16, Hz |.
inline constexpr std::size_t kOutputSize = 4;
inline constexpr std::size_t kOutputIdOffset = 0;
inline constexpr std::size_t kOutputRateOffset = 2;
inline constexpr std::uint16_t kWithEveryMessage = 0xFFFF;
static_assert(kOutputRateOffset + sizeof(std::uint16_t) == kOutputSize);

struct MtOutput {
  DataType type;
  std::size_t size;  // bytes of data: float32, ENU
  bool at_rate;      // or with every message
};

inline constexpr std::array kMtOutputs{
    MtOutput{DataType::packet_counter, 2, false}, MtOutput{DataType::sample_time_fine, 4, false},
    MtOutput{DataType::quaternion, 16, true},     MtOutput{DataType::acceleration, 12, true},
    MtOutput{DataType::rate_of_turn, 12, true},   MtOutput{DataType::status_word, 4, false}};
inline constexpr std::size_t kMtOutputListSize = kMtOutputs.size() * kOutputSize;

// Of a whole message with these outputs.
[[nodiscard]] constexpr std::size_t mt_message_size() noexcept {
  std::size_t size = kHeaderSize + kChecksumSize;
  for (const MtOutput& output : kMtOutputs) size += kItemDataOffset + output.size;
  return size;
}

// The rates that orientation can have: those that divide 400 Hz.
inline constexpr std::uint16_t kMaxMtRate = 400;

// The highest of them that is at most `wanted` and that a line of `baud` bit/s carries (0: any);
// at least 1.
[[nodiscard]] constexpr std::uint16_t mt_rate_for(std::uint16_t wanted,
                                                  std::uint32_t baud) noexcept {
  constexpr std::size_t kBitsPerByte = 10;
  for (std::uint16_t rate = wanted; rate > 1; --rate) {
    const bool fits = baud == 0 || rate * mt_message_size() * kBitsPerByte <= baud;
    if (kMaxMtRate % rate == 0 && fits) return rate;
  }
  return 1;
}

[[nodiscard]] inline std::array<std::byte, kMtOutputListSize> mt_output_list(
    std::uint16_t rate_hz) noexcept {
  std::array<std::byte, kMtOutputListSize> list;
  std::size_t at = 0;
  for (const MtOutput& output : kMtOutputs) {
    wire::store_be<std::uint16_t>(list, at + kOutputIdOffset,
                                  static_cast<std::uint16_t>(output.type));
    wire::store_be<std::uint16_t>(list, at + kOutputRateOffset,
                                  output.at_rate ? rate_hz : kWithEveryMessage);
    at += kOutputSize;
  }
  return list;
}

}  // namespace convexcut::xsens
