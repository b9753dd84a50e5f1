// SPDX-License-Identifier: Apache-2.0
//
// What a capture file holds, one record at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/time.hpp"
#include "drivers/ipv4_address.hpp"

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
