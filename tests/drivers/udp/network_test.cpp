// SPDX-License-Identifier: Apache-2.0
//
// Interfaces that come and go, in a network namespace with a cable (veth) of its own. Does not
// prove anything about the drivers of real network cards.
#include <cerrno>

#include <gtest/gtest.h>

#include "tests/drivers/udp/udp_rig.hpp"
#include "tests/support/network_namespace.hpp"

namespace convexcut::udp {
namespace {

using convexcut::test::in_network_namespace;
using convexcut::test::ip;
using convexcut::test::set_ipv4;
using convexcut::test::UdpSender;
using test::UdpRig;
using velodyne::test::DataPacket;

constexpr const char* kBroadcast = "255.255.255.255";
constexpr const char* kGroup = "239.192.0.1";
constexpr Ipv4Address kGroupAddress = Ipv4Address::from_octets(239, 192, 0, 1);

// A cable from the sensor to the host, both ends in this namespace; the host's end is down.
void lay_cable() {
  ip("link add sensor type veth peer name host");
  ip("address add 192.168.1.201/24 dev sensor");
  ip("link set sensor up");
  // The sensor's packets come from an address that is also this host's own.
  set_ipv4("host", "accept_local", 1);
  set_ipv4("host", "rp_filter", 0);
}

// What a sensor does: it sends on, whether anybody hears it or not.
bool hears(UdpRig& rig, const char* address) {
  UdpSender sensor;
  sensor.through("sensor");
  const std::uint64_t before = rig.driver.counters().data_packets.value();
  return rig.receive_until([&] {
    static_cast<void>(sensor.try_send(address, rig.data_port, DataPacket().bytes()));
    return rig.driver.counters().data_packets.value() > before;
  });
}

TEST(UdpNetwork, SourceThatWasOpenedBeforeAnyNetworkHearsASensorThatComesLater) {
  in_network_namespace([] {
    set_ipv4("all", "rp_filter", 0);
    UdpRig rig;
    ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
    lay_cable();
    ip("link set host up");
    EXPECT_TRUE(hears(rig, kBroadcast));
    EXPECT_EQ(rig.source.counters().opened.value(), 1U);
  });
}

TEST(UdpNetwork, CableThatIsPulledAndPutBackNeedsNothing) {
  in_network_namespace([] {
    set_ipv4("all", "rp_filter", 0);
    lay_cable();
    ip("link set host up");
    UdpRig rig;
    ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
    ASSERT_TRUE(hears(rig, kBroadcast));
    ip("link set host down");
    rig.source.receive(Duration{0});
    ip("link set host up");
    EXPECT_TRUE(hears(rig, kBroadcast));
    EXPECT_EQ(rig.source.counters().receive_errors.value(), 0U);
  });
}

TEST(UdpNetwork, LinkFollowsTheConfiguredInterface) {
  in_network_namespace([] {
    set_ipv4("all", "rp_filter", 0);
    UdpRig rig({.interface = "host"});
    ASSERT_TRUE(rig.receive_until([&] { return rig.source.last_error() == ENODEV; }));
    lay_cable();
    ASSERT_TRUE(rig.receive_until([&] { return rig.source.last_error() == ENETDOWN; }));
    EXPECT_EQ(rig.source.link(), live::LinkState::closed);
    ip("link set host up");
    EXPECT_TRUE(rig.link_becomes(live::LinkState::open));
    EXPECT_TRUE(hears(rig, kBroadcast));
    ip("link set sensor down");  // the carrier goes
    EXPECT_TRUE(rig.link_becomes(live::LinkState::closed));
    ip("link set sensor up");
    EXPECT_TRUE(rig.link_becomes(live::LinkState::open));
    EXPECT_TRUE(hears(rig, kBroadcast));
    EXPECT_EQ(rig.source.counters().opened.value(), 1U);
  });
}

TEST(UdpNetwork, AdapterThatIsPluggedInAgainIsBoundAnew) {
  in_network_namespace([] {
    set_ipv4("all", "rp_filter", 0);
    lay_cable();
    ip("link set host up");
    UdpRig rig({.interface = "host"});
    ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
    ASSERT_TRUE(hears(rig, kBroadcast));
    ip("link delete host");
    ASSERT_TRUE(rig.receive_until([&] { return rig.source.last_error() == ENODEV; }));
    lay_cable();
    ip("link set host up");
    EXPECT_TRUE(rig.link_becomes(live::LinkState::open));
    EXPECT_TRUE(hears(rig, kBroadcast));
    EXPECT_EQ(rig.source.counters().opened.value(), 2U);
  });
}

TEST(UdpNetwork, GroupIsJoinedWhenTheInterfaceComesUpAndAgainAfterReplugging) {
  in_network_namespace([] {
    set_ipv4("all", "rp_filter", 0);
    UdpRig rig({.multicast_group = kGroupAddress, .interface = "host"});
    for (int plugged = 0; plugged < 2; ++plugged) {
      rig.source.receive(Duration{0});
      lay_cable();
      ip("link set host up");
      EXPECT_TRUE(hears(rig, kGroup));
      ip("link delete host");
      EXPECT_TRUE(rig.link_becomes(live::LinkState::closed));
    }
  });
}

TEST(UdpNetwork, GroupOnAnyInterfaceIsTriedUntilThereIsARoute) {
  in_network_namespace([] {
    set_ipv4("all", "rp_filter", 0);
    UdpRig rig({.multicast_group = kGroupAddress});
    ASSERT_TRUE(rig.receive_until([&] { return rig.source.last_error() == ENODEV; }));
    lay_cable();
    ip("link set host up");
    ip("route add 239.192.0.0/16 dev host");
    EXPECT_TRUE(rig.link_becomes(live::LinkState::open));
    EXPECT_TRUE(hears(rig, kGroup));
    EXPECT_EQ(rig.source.counters().opened.value(), 1U);
  });
}

TEST(UdpNetwork, GroupThatSomeoneElseJoinedIsNotHeard) {
  in_network_namespace([] {
    set_ipv4("all", "rp_filter", 0);
    lay_cable();
    ip("link set host up");
    UdpRig rig;
    ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
    UdpRig other({.multicast_group = kGroupAddress, .interface = "host"});
    ASSERT_TRUE(hears(other, kGroup));
    UdpSender sensor;
    sensor.through("sensor");
    sensor.send(kGroup, rig.data_port, DataPacket().timestamp(1).bytes());
    sensor.send(kBroadcast, rig.data_port, DataPacket().timestamp(2).bytes());
    ASSERT_TRUE(rig.receive_datagrams(1));
    EXPECT_EQ(rig.sink.batches.at(0).first_firing.count, 2U);
  });
}

}  // namespace
}  // namespace convexcut::udp
