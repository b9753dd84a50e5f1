// SPDX-License-Identifier: Apache-2.0
#include "drivers/capture/network_frame.hpp"

#include <cstddef>

#include "drivers/capture/wire_layout.hpp"

namespace convexcut::capture {
namespace {

using wire::Bytes;
using wire::load_be;
using wire::load_u8;

// A frame that is too short for what its headers say: whose fault it is.
FrameVerdict too_short(bool cut) noexcept {
  return cut ? FrameVerdict::truncated : FrameVerdict::malformed;
}

// `datagram` is bounded by the IP header's length, and by what was captured of it.
FrameVerdict parse_udp(Bytes datagram, bool cut, Record& record) noexcept {
  if (datagram.size() < udp::kHeaderSize) return too_short(cut);
  const std::size_t length = load_be<std::uint16_t>(datagram, udp::kLength);
  if (length < udp::kHeaderSize) return FrameVerdict::malformed;
  if (length > datagram.size()) return too_short(cut);
  record.source_port = load_be<std::uint16_t>(datagram, udp::kSourcePort);
  record.destination_port = load_be<std::uint16_t>(datagram, udp::kDestinationPort);
  record.payload = datagram.subspan(udp::kHeaderSize, length - udp::kHeaderSize);
  return FrameVerdict::datagram;
}

FrameVerdict parse_ipv4(Bytes packet, bool cut, Record& record) noexcept {
  if (packet.size() < ipv4::kMinHeaderSize) return too_short(cut);
  const unsigned version_and_words = load_u8(packet, ipv4::kVersionAndHeaderWords);
  const std::size_t header_size = (version_and_words & 0x0FU) * ipv4::kWord;
  if (version_and_words >> 4U != 4U || header_size < ipv4::kMinHeaderSize) {
    return FrameVerdict::malformed;
  }
  if (load_u8(packet, ipv4::kProtocol) != udp::kProtocol) return FrameVerdict::other;
  if ((load_be<std::uint16_t>(packet, ipv4::kFragment) & ipv4::kFragmentMask) != 0) {
    return FrameVerdict::fragment;
  }
  const std::size_t total_length = load_be<std::uint16_t>(packet, ipv4::kTotalLength);
  if (total_length < header_size) return FrameVerdict::malformed;
  if (total_length > packet.size()) return too_short(cut);
  record.source = Ipv4Address{load_be<std::uint32_t>(packet, ipv4::kSource)};
  record.destination = Ipv4Address{load_be<std::uint32_t>(packet, ipv4::kDestination)};
  // The packet is all there: whatever does not fit from here on is the sender's fault.
  return parse_udp(packet.subspan(header_size, total_length - header_size), false, record);
}

FrameVerdict parse_ipv6(Bytes packet, bool cut, Record& record) noexcept {
  if (packet.size() < ipv6::kHeaderSize) return too_short(cut);
  if (load_u8(packet, 0) >> 4U != 6U) return FrameVerdict::malformed;
  const std::uint8_t next_header = load_u8(packet, ipv6::kNextHeader);
  if (next_header == ipv6::kFragmentHeader) return FrameVerdict::fragment;
  if (next_header != udp::kProtocol) return FrameVerdict::other;
  const std::size_t payload_length = load_be<std::uint16_t>(packet, ipv6::kPayloadLength);
  if (payload_length > packet.size() - ipv6::kHeaderSize) return too_short(cut);
  return parse_udp(packet.subspan(ipv6::kHeaderSize, payload_length), false, record);
}

// What follows an EtherType: VLAN tags, then IP.
FrameVerdict parse_ether_type(std::uint16_t type, Bytes rest, bool cut, Record& record) noexcept {
  for (int tags = 0; type == ethernet::kVlan || type == ethernet::kServiceVlan; ++tags) {
    if (tags == ethernet::kMaxVlanTags) return FrameVerdict::other;
    if (rest.size() < ethernet::kVlanTagSize) return too_short(cut);
    type = load_be<std::uint16_t>(rest, ethernet::kVlanEtherType);
    rest = rest.subspan(ethernet::kVlanTagSize);
  }
  if (type == ethernet::kIpv4) return parse_ipv4(rest, cut, record);
  if (type == ethernet::kIpv6) return parse_ipv6(rest, cut, record);
  return FrameVerdict::other;
}

FrameVerdict parse_link(CapturedFrame frame, std::size_t type_offset, std::size_t header_size,
                        Record& record) noexcept {
  if (frame.bytes.size() < header_size) return too_short(frame.cut);
  return parse_ether_type(load_be<std::uint16_t>(frame.bytes, type_offset),
                          frame.bytes.subspan(header_size), frame.cut, record);
}

FrameVerdict parse_raw_ip(CapturedFrame frame, Record& record) noexcept {
  if (frame.bytes.empty()) return too_short(frame.cut);
  const unsigned version = load_u8(frame.bytes, 0) >> 4U;
  if (version == 4U) return parse_ipv4(frame.bytes, frame.cut, record);
  if (version == 6U) return parse_ipv6(frame.bytes, frame.cut, record);
  return FrameVerdict::malformed;
}

}  // namespace

FrameVerdict parse_frame(LinkKind link, CapturedFrame frame, Record& record) noexcept {
  switch (link) {
    case LinkKind::ethernet:
      return parse_link(frame, ethernet::kEtherType, ethernet::kHeaderSize, record);
    case LinkKind::linux_cooked:
      return parse_link(frame, linux_cooked::kProtocol, linux_cooked::kHeaderSize, record);
    case LinkKind::linux_cooked2:
      return parse_link(frame, linux_cooked2::kProtocol, linux_cooked2::kHeaderSize, record);
    case LinkKind::raw_ip:
      return parse_raw_ip(frame, record);
    case LinkKind::serial:
    case LinkKind::can:
      break;
  }
  return FrameVerdict::other;
}

}  // namespace convexcut::capture
