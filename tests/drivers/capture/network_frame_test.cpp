// SPDX-License-Identifier: Apache-2.0
//
// Frames of every supported link. Does not prove that these are the layouts that capture tools
// write: the recordings in capture_reader_test.cpp do, for Ethernet.
#include "drivers/capture/network_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/capture/capture_bytes.hpp"

namespace convexcut::capture {
namespace {

using test::ethernet;
using test::ipv4;
using test::ipv6;
using test::kEtherTypeIpv4;
using test::kEtherTypeIpv6;
using test::Octets;
using test::OctetWriter;
using test::text;
using test::Udp;
using ::testing::ElementsAreArray;

constexpr std::uint16_t kVlan = 0x8100;
constexpr std::uint16_t kServiceVlan = 0x88A8;

Udp hello() { return {.source_port = 443, .payload = text("hello")}; }

struct Parsed {
  FrameVerdict verdict;
  Record record;
};

Parsed parse(LinkKind link, const Octets& frame, bool cut = false) {
  Parsed parsed{};
  parsed.verdict = parse_frame(link, {frame, cut}, parsed.record);
  return parsed;
}

void expect_hello(const Parsed& parsed) {
  ASSERT_EQ(parsed.verdict, FrameVerdict::datagram);
  EXPECT_THAT(parsed.record.payload, ElementsAreArray(text("hello")));
  EXPECT_EQ(parsed.record.source_port, 443);
  EXPECT_EQ(parsed.record.destination_port, 2368);
}

TEST(NetworkFrame, EthernetDatagramHasItsAddressesAndPorts) {
  const Octets frame = ethernet(kEtherTypeIpv4, ipv4(hello()));
  const Parsed parsed = parse(LinkKind::ethernet, frame);
  expect_hello(parsed);
  EXPECT_EQ(parsed.record.source, Ipv4Address::from_octets(192, 168, 1, 201));
  EXPECT_EQ(parsed.record.destination, Ipv4Address::from_octets(255, 255, 255, 255));
}

TEST(NetworkFrame, OneOrTwoVlanTagsArePassedOver) {
  const Octets once = test::vlan_tag(kEtherTypeIpv4, ipv4(hello()));
  const Octets twice = test::vlan_tag(kVlan, once);
  const Octets tagged = ethernet(kVlan, once);
  const Octets double_tagged = ethernet(kServiceVlan, twice);
  expect_hello(parse(LinkKind::ethernet, tagged));
  expect_hello(parse(LinkKind::ethernet, double_tagged));
  const Octets triple_tagged = ethernet(kServiceVlan, test::vlan_tag(kVlan, twice));
  EXPECT_EQ(parse(LinkKind::ethernet, triple_tagged).verdict, FrameVerdict::other);
}

TEST(NetworkFrame, LinuxCookedOfBothVersions) {
  const Octets first = test::linux_cooked(kEtherTypeIpv4, ipv4(hello()));
  const Octets second = test::linux_cooked2(kEtherTypeIpv4, ipv4(hello()));
  expect_hello(parse(LinkKind::linux_cooked, first));
  expect_hello(parse(LinkKind::linux_cooked2, second));
}

TEST(NetworkFrame, RawIpOfBothVersions) {
  const Octets four = ipv4(hello());
  const Octets six = ipv6(hello());
  expect_hello(parse(LinkKind::raw_ip, four));
  expect_hello(parse(LinkKind::raw_ip, six));
  EXPECT_EQ(parse(LinkKind::raw_ip, {std::byte{0x50}}).verdict, FrameVerdict::malformed);
}

TEST(NetworkFrame, Ipv6DatagramHasNoIpv4Addresses) {
  const Octets frame = ethernet(kEtherTypeIpv6, ipv6(hello()));
  const Parsed parsed = parse(LinkKind::ethernet, frame);
  expect_hello(parsed);
  EXPECT_EQ(parsed.record.source, std::nullopt);
  EXPECT_EQ(parsed.record.destination, std::nullopt);
}

TEST(NetworkFrame, Ipv6ExtensionHeadersAreNotFollowed) {
  Octets packet = ipv6(hello());
  packet[6] = std::byte{0};  // hop-by-hop options
  EXPECT_EQ(parse(LinkKind::raw_ip, packet).verdict, FrameVerdict::other);
  packet[6] = std::byte{44};
  EXPECT_EQ(parse(LinkKind::raw_ip, packet).verdict, FrameVerdict::fragment);
}

TEST(NetworkFrame, Ipv4OptionsArePassedOver) {
  const Octets frame = ethernet(kEtherTypeIpv4, ipv4(hello(), Octets(40, std::byte{1})));
  expect_hello(parse(LinkKind::ethernet, frame));
}

TEST(NetworkFrame, EthernetPaddingIsNotPayload) {
  Octets frame = ethernet(kEtherTypeIpv4, ipv4(hello()));
  frame.resize(60, std::byte{0xEE});
  expect_hello(parse(LinkKind::ethernet, frame));
}

TEST(NetworkFrame, PayloadEndsWhereUdpSaysAlsoInsideALongerIpPacket) {
  Octets packet = ipv4({.source_port = 443, .payload = text("hello, longer")});
  packet[20 + 5] = std::byte{8 + 5};
  expect_hello(parse(LinkKind::raw_ip, packet));
}

TEST(NetworkFrame, EmptyDatagramIsADatagram) {
  const Octets packet = ipv4({});
  const Parsed parsed = parse(LinkKind::raw_ip, packet);
  EXPECT_EQ(parsed.verdict, FrameVerdict::datagram);
  EXPECT_TRUE(parsed.record.payload.empty());
}

TEST(NetworkFrame, FirstAndLaterFragmentsAreNotDatagrams) {
  constexpr std::uint16_t kMoreFragments = 0x2000;
  EXPECT_EQ(parse(LinkKind::raw_ip, ipv4(hello(), {}, kMoreFragments)).verdict,
            FrameVerdict::fragment);
  EXPECT_EQ(parse(LinkKind::raw_ip, ipv4(hello(), {}, 185)).verdict, FrameVerdict::fragment);
}

TEST(NetworkFrame, DontFragmentIsNotAFragment) {
  const Octets packet = ipv4(hello(), {}, 0x4000);
  expect_hello(parse(LinkKind::raw_ip, packet));
}

TEST(NetworkFrame, ArpTcpAndOldLengthFramesAreOther) {
  EXPECT_EQ(parse(LinkKind::ethernet, ethernet(0x0806, Octets(28))).verdict, FrameVerdict::other);
  EXPECT_EQ(parse(LinkKind::ethernet, ethernet(46, Octets(46))).verdict, FrameVerdict::other);
  Octets tcp = ipv4(hello());
  tcp[9] = std::byte{6};
  EXPECT_EQ(parse(LinkKind::raw_ip, tcp).verdict, FrameVerdict::other);
}

TEST(NetworkFrame, EveryLengthShortOfTheDatagramIsTruncatedOrMalformed) {
  const Octets option(4, std::byte{1});
  const Octets frame = ethernet(
      kServiceVlan, test::vlan_tag(kVlan, test::vlan_tag(kEtherTypeIpv4, ipv4(hello(), option))));
  for (std::size_t size = 0; size < frame.size(); ++size) {
    const Octets part(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(parse(LinkKind::ethernet, part, true).verdict, FrameVerdict::truncated) << size;
    EXPECT_EQ(parse(LinkKind::ethernet, part, false).verdict, FrameVerdict::malformed) << size;
  }
  expect_hello(parse(LinkKind::ethernet, frame));
}

TEST(NetworkFrame, EveryLengthShortOfAnIpv6DatagramIsTruncated) {
  const Octets frame = test::linux_cooked2(kEtherTypeIpv6, ipv6(hello()));
  for (std::size_t size = 0; size < frame.size(); ++size) {
    const Octets part(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(parse(LinkKind::linux_cooked2, part, true).verdict, FrameVerdict::truncated) << size;
  }
}

TEST(NetworkFrame, DatagramThatSurvivedTheSnapshotLengthIsUsed) {
  Octets frame = ethernet(kEtherTypeIpv4, ipv4(hello()));
  frame.resize(frame.size() + 3);  // of a longer padding
  expect_hello(parse(LinkKind::ethernet, frame, true));
}

struct Corruption {
  const char* what;
  std::size_t offset;
  std::uint8_t value;
};

class CorruptIpv4 : public ::testing::TestWithParam<Corruption> {};

TEST_P(CorruptIpv4, IsMalformed) {
  Octets packet = ipv4(hello());
  packet[GetParam().offset] = std::byte{GetParam().value};
  // Behind Ethernet, so that a wrong version is not taken for another protocol.
  EXPECT_EQ(parse(LinkKind::ethernet, ethernet(kEtherTypeIpv4, packet)).verdict,
            FrameVerdict::malformed);
}

INSTANTIATE_TEST_SUITE_P(NetworkFrame, CorruptIpv4,
                         ::testing::Values(Corruption{"Version", 0, 0x65},
                                           Corruption{"HeaderTooShort", 0, 0x44},
                                           Corruption{"HeaderLongerThanPacket", 0, 0x4F},
                                           Corruption{"TotalLengthInsideHeader", 3, 19},
                                           Corruption{"TotalLengthWithoutUdpHeader", 3, 27},
                                           Corruption{"TotalLengthBeyondFrame", 3, 34},
                                           Corruption{"UdpLengthInsideHeader", 25, 7},
                                           Corruption{"UdpLengthZero", 25, 0},
                                           Corruption{"UdpLengthBeyondPacket", 25, 14}),
                         [](const auto& test) { return std::string(test.param.what); });

TEST(NetworkFrame, WrongVersionBehindIpv6EtherTypeIsMalformed) {
  EXPECT_EQ(parse(LinkKind::ethernet, ethernet(kEtherTypeIpv6, Octets(48))).verdict,
            FrameVerdict::malformed);
}

}  // namespace
}  // namespace convexcut::capture
