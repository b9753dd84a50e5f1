// SPDX-License-Identifier: Apache-2.0
//
// What a capture file holds, one record at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/time.hpp"

namespace convexcut::capture {

// The link types (https://www.tcpdump.org/linktypes.html) that are understood, by what they carry.
enum class LinkKind : std::uint8_t {
  ethernet,       // LINKTYPE_ETHERNET (1), with up to two VLAN tags
  linux_cooked,   // LINKTYPE_LINUX_SLL (113): captures on "any"
  linux_cooked2,  // LINKTYPE_LINUX_SLL2 (276): the same from newer tools
  raw_ip,         // LINKTYPE_RAW (101)
  serial,         // LINKTYPE_USER0 (147): a record is the bytes of one read of a serial line
  can,            // LINKTYPE_CAN_SOCKETCAN (227)
};

enum class RecordKind : std::uint8_t {
  datagram,  // a whole UDP datagram
  serial,
  can,  // the payload is the record as captured: 8 byte header with a big-endian id, then the data
  other,  // anything else on a network (ARP, TCP, …); no payload
};

struct Ipv4Address {
  std::uint32_t value = 0;  // 192.168.1.201 is 0xC0A801C9

  [[nodiscard]] static constexpr Ipv4Address from_octets(std::uint8_t a, std::uint8_t b,
                                                         std::uint8_t c, std::uint8_t d) noexcept {
    return {(std::uint32_t{a} << 24U) | (std::uint32_t{b} << 16U) | (std::uint32_t{c} << 8U) | d};
  }
  friend constexpr bool operator==(Ipv4Address, Ipv4Address) = default;
};

// The addresses and ports are those of a datagram; an IPv6 datagram has ports only.
struct Record {
  HostTime stamp{};
  RecordKind kind = RecordKind::other;
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  std::optional<Ipv4Address> source = std::nullopt;
  std::optional<Ipv4Address> destination = std::nullopt;
  std::span<const std::byte> payload{};
};

}  // namespace convexcut::capture
