// SPDX-License-Identifier: Apache-2.0
//
// The codes of bit rates in SetBaudrate (xsbaudcode.h of the Xsens SDK).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace convexcut::xsens {

struct BaudCode {
  std::uint32_t baud;  // bit/s
  std::uint8_t code;
};

// The first code of a rate is the one to send: 0x80 for 921600 is understood by older devices and
// newer ones alike, 0x0A by newer ones only.
inline constexpr std::array kBaudCodes{
    BaudCode{4800, 0x0B},   BaudCode{9600, 0x09},    BaudCode{14400, 0x08},
    BaudCode{19200, 0x07},  BaudCode{28800, 0x06},   BaudCode{38400, 0x05},
    BaudCode{57600, 0x04},  BaudCode{76800, 0x03},   BaudCode{115200, 0x02},
    BaudCode{230400, 0x01}, BaudCode{460800, 0x00},  BaudCode{921600, 0x80},
    BaudCode{921600, 0x0A}, BaudCode{2000000, 0x0C}, BaudCode{3500000, 0x0E},
    BaudCode{4000000, 0x0D}};

[[nodiscard]] constexpr std::optional<std::uint8_t> code_of_baud(std::uint32_t baud) noexcept {
  for (const BaudCode& row : kBaudCodes) {
    if (row.baud == baud) return row.code;
  }
  return std::nullopt;
}

[[nodiscard]] constexpr std::optional<std::uint32_t> baud_of_code(std::uint8_t code) noexcept {
  for (const BaudCode& row : kBaudCodes) {
    if (row.code == code) return row.baud;
  }
  return std::nullopt;
}

}  // namespace convexcut::xsens
