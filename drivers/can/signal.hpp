// SPDX-License-Identifier: Apache-2.0
//
// One number in the data of a CAN frame, as DBC files describe it: bits, byte order, sign, scale
// and offset.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/can/can_frame.hpp"

namespace convexcut::can {

enum class ByteOrder : std::uint8_t {
  intel,     // least significant byte first (DBC: @1)
  motorola,  // most significant byte first (DBC: @0)
};

struct Signal {
  static constexpr unsigned kMaxLength = 64;
  static constexpr std::size_t kMaxPrefix = 4;

  ByteOrder order = ByteOrder::intel;
  // Bit n is bit n % 8 (0: least significant) of byte n / 8. Of an Intel signal the least
  // significant bit is given, of a Motorola signal the most significant one.
  unsigned start_bit = 0;
  unsigned length = 32;  // bits
  bool is_signed = true;
  double scale = 1.0;  // value = raw · scale + offset
  double offset = 0.0;
  // Frames that do not begin with these bytes hold something else: a multiplexer, an SDO's object.
  std::array<std::byte, kMaxPrefix> prefix{};
  std::size_t prefix_length = 0;
};

// Bytes of data up to the signal's last bit and of its prefix; none when it has no or too many
// bits, or does not fit a CAN FD frame.
[[nodiscard]] std::optional<std::size_t> needed_length(const Signal& signal) noexcept;

[[nodiscard]] bool has_prefix(const Signal& signal, std::span<const std::byte> data) noexcept;

// Precondition: needed_length() has a value, and `data` is at least as long. RT.
[[nodiscard]] double value_of(const Signal& signal, std::span<const std::byte> data) noexcept;

// Position actual value, object 0x6064 of CiA 402, INTEGER32 in counts, behind the statusword
// (object 0x6041) in a transmit PDO: bytes 2 … 5. Identifier 0x180 + node for TPDO1, + 0x100 for
// each further.
[[nodiscard]] Signal cia402_position() noexcept;
// The same in the answers to somebody's expedited SDO uploads (CiA 301: command 0x43, index and
// subindex): bytes 4 … 7. Identifier 0x580 + node.
[[nodiscard]] Signal cia402_position_sdo() noexcept;

}  // namespace convexcut::can
