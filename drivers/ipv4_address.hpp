// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut {

struct Ipv4Address {
  std::uint32_t value = 0;  // 192.168.1.201 is 0xC0A801C9

  [[nodiscard]] static constexpr Ipv4Address from_octets(std::uint8_t a, std::uint8_t b,
                                                         std::uint8_t c, std::uint8_t d) noexcept {
    return {(std::uint32_t{a} << 24U) | (std::uint32_t{b} << 16U) | (std::uint32_t{c} << 8U) | d};
  }
  friend constexpr bool operator==(Ipv4Address, Ipv4Address) = default;
};

}  // namespace convexcut
