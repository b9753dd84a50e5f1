// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/signal.hpp"

#include <algorithm>
#include <bit>

namespace convexcut::can {
namespace {

constexpr unsigned kByteBits = 8;

[[nodiscard]] std::uint64_t bit_at(std::span<const std::byte> data, unsigned position) noexcept {
  return std::to_integer<std::uint64_t>(data[position / kByteBits] >> (position % kByteBits)) & 1U;
}

// The next less significant bit: towards bit 0 of a byte, then bit 7 of the one behind.
[[nodiscard]] unsigned next_motorola(unsigned position) noexcept {
  return position % kByteBits == 0 ? position + 2 * kByteBits - 1 : position - 1;
}

[[nodiscard]] std::uint64_t raw_bits(const Signal& signal,
                                     std::span<const std::byte> data) noexcept {
  std::uint64_t raw = 0;
  if (signal.order == ByteOrder::intel) {
    for (unsigned i = 0; i < signal.length; ++i) raw |= bit_at(data, signal.start_bit + i) << i;
  } else {
    unsigned position = signal.start_bit;
    for (unsigned i = 0; i < signal.length; ++i) {
      raw = raw << 1U | bit_at(data, position);
      position = next_motorola(position);
    }
  }
  return raw;
}

// Bytes up to the last bit.
[[nodiscard]] std::size_t spanned_length(const Signal& signal) noexcept {
  if (signal.order == ByteOrder::intel) {
    return (std::size_t{signal.start_bit} + signal.length - 1) / kByteBits + 1;
  }
  const unsigned in_first = signal.start_bit % kByteBits + 1;
  const unsigned behind = signal.length - std::min(signal.length, in_first);
  return std::size_t{signal.start_bit} / kByteBits + 1 + (behind + kByteBits - 1) / kByteBits;
}

}  // namespace

std::optional<std::size_t> needed_length(const Signal& signal) noexcept {
  if (signal.length == 0 || signal.length > Signal::kMaxLength) return std::nullopt;
  if (signal.start_bit >= kMaxFdLength * kByteBits) return std::nullopt;
  if (signal.prefix_length > Signal::kMaxPrefix) return std::nullopt;
  const std::size_t length = std::max(spanned_length(signal), signal.prefix_length);
  if (length > kMaxFdLength) return std::nullopt;
  return length;
}

bool has_prefix(const Signal& signal, std::span<const std::byte> data) noexcept {
  if (data.size() < signal.prefix_length) return false;
  return std::equal(signal.prefix.begin(),
                    signal.prefix.begin() + static_cast<std::ptrdiff_t>(signal.prefix_length),
                    data.begin());
}

double value_of(const Signal& signal, std::span<const std::byte> data) noexcept {
  const std::uint64_t raw = raw_bits(signal, data);
  if (!signal.is_signed) return static_cast<double>(raw) * signal.scale + signal.offset;
  const unsigned unused = Signal::kMaxLength - signal.length;
  const auto extended = std::bit_cast<std::int64_t>(raw << unused) >> unused;
  return static_cast<double>(extended) * signal.scale + signal.offset;
}

Signal cia402_position() noexcept {
  Signal signal;
  signal.start_bit = 16;
  return signal;
}

Signal cia402_position_sdo() noexcept {
  Signal signal;
  signal.start_bit = 32;
  signal.prefix = {std::byte{0x43}, std::byte{0x64}, std::byte{0x60}, std::byte{0x00}};
  signal.prefix_length = 4;
  return signal;
}

}  // namespace convexcut::can
