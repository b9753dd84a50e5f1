// SPDX-License-Identifier: Apache-2.0
//
// Offsets and codes of the network headers, in bytes from the start of each header. All numbers are
// big-endian.
#pragma once

#include <cstddef>
#include <cstdint>

namespace convexcut::capture {

// IEEE 802.3 and 802.1Q.
namespace ethernet {
inline constexpr std::size_t kDestination = 0;
inline constexpr std::size_t kSource = 6;
inline constexpr std::size_t kEtherType = 12;
inline constexpr std::size_t kHeaderSize = 14;
inline constexpr std::size_t kVlanTagSize = 4;  // the tag's control word, then the next EtherType
inline constexpr std::size_t kVlanEtherType = 2;
inline constexpr int kMaxVlanTags = 2;
inline constexpr std::uint16_t kIpv4 = 0x0800;
inline constexpr std::uint16_t kIpv6 = 0x86DD;
inline constexpr std::uint16_t kVlan = 0x8100;         // 802.1Q
inline constexpr std::uint16_t kServiceVlan = 0x88A8;  // 802.1ad
static_assert(kEtherType + sizeof(std::uint16_t) == kHeaderSize);
static_assert(kVlanEtherType + sizeof(std::uint16_t) == kVlanTagSize);
}  // namespace ethernet

// https://www.tcpdump.org/linktypes/LINKTYPE_LINUX_SLL.html and …_SLL2.html
namespace linux_cooked {
inline constexpr std::size_t kProtocol = 14;
inline constexpr std::size_t kHeaderSize = 16;
static_assert(kProtocol + sizeof(std::uint16_t) == kHeaderSize);
}  // namespace linux_cooked
namespace linux_cooked2 {
inline constexpr std::size_t kProtocol = 0;
inline constexpr std::size_t kHeaderSize = 20;
}  // namespace linux_cooked2

// RFC 791.
namespace ipv4 {
inline constexpr std::size_t kVersionAndHeaderWords = 0;
inline constexpr std::size_t kTotalLength = 2;
inline constexpr std::size_t kFragment = 6;
inline constexpr std::size_t kTimeToLive = 8;
inline constexpr std::size_t kProtocol = 9;
inline constexpr std::size_t kChecksum = 10;
inline constexpr std::size_t kSource = 12;
inline constexpr std::size_t kDestination = 16;
inline constexpr std::size_t kMinHeaderSize = 20;
inline constexpr std::size_t kWord = 4;  // the header's length counts these
// "More fragments" and the offset: all zero in a datagram that is whole.
inline constexpr std::uint16_t kFragmentMask = 0x3FFF;
static_assert(kDestination + sizeof(std::uint32_t) == kMinHeaderSize);
}  // namespace ipv4

// RFC 8200.
namespace ipv6 {
inline constexpr std::size_t kPayloadLength = 4;
inline constexpr std::size_t kNextHeader = 6;
inline constexpr std::size_t kHeaderSize = 40;
inline constexpr std::uint8_t kFragmentHeader = 44;
}  // namespace ipv6

// RFC 768.
namespace udp {
inline constexpr std::uint8_t kProtocol = 17;
inline constexpr std::size_t kSourcePort = 0;
inline constexpr std::size_t kDestinationPort = 2;
inline constexpr std::size_t kLength = 4;
inline constexpr std::size_t kHeaderSize = 8;
inline constexpr std::size_t kMaxPayload = 65535 - ipv4::kMinHeaderSize - kHeaderSize;
}  // namespace udp

static_assert(ethernet::kHeaderSize + ipv4::kMinHeaderSize + udp::kHeaderSize == 42,
              "the HDL-32E's 1206 bytes travel in frames of 1248");

}  // namespace convexcut::capture
