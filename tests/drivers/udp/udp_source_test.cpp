// SPDX-License-Identifier: Apache-2.0
//
// Datagrams over the loopback interface. Does not prove what a network card loses or delays.
#include "drivers/udp/udp_source.hpp"

#include <cerrno>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "drivers/live/host_clock.hpp"
#include "tests/drivers/udp/udp_rig.hpp"

namespace convexcut::udp {
namespace {

using convexcut::test::UdpSender;
using test::UdpRig;
using velodyne::test::DataPacket;
using velodyne::test::PositionDatagram;

constexpr const char* kHere = "127.0.0.1";

TEST(UdpSource, DataPacketReachesTheDriverWithTheKernelsStamp) {
  UdpRig rig;
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  const HostTime before = live::host_now();
  UdpSender().send(kHere, rig.data_port, DataPacket().timestamp(77).bytes());
  const HostTime after = live::host_now();
  // What is done meanwhile does not move the stamp.
  ASSERT_TRUE(rig.receive_datagrams(1));
  ASSERT_EQ(rig.sink.batches.size(), 1U);
  EXPECT_EQ(rig.sink.batches[0].first_firing.count, 77U);
  EXPECT_GE(rig.sink.batches[0].arrival, before);
  EXPECT_LE(rig.sink.batches[0].arrival, after);
}

TEST(UdpSource, PositionPacketReachesTheDriver) {
  UdpRig rig;
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  UdpSender().send(kHere, rig.position_port, PositionDatagram().pps(2).bytes());
  ASSERT_TRUE(rig.receive_datagrams(1));
  EXPECT_EQ(rig.driver.counters().position_packets.value(), 1U);
  EXPECT_EQ(rig.driver.counters().data_packets.value(), 0U);
}

TEST(UdpSource, EveryDatagramOfABurstIsReceivedInOrder) {
  constexpr std::uint32_t kBurst = 1500;
  UdpRig rig;
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  if (rig.source.receive_buffer_bytes() < UdpSocketOptions{}.receive_buffer_bytes) {
    GTEST_SKIP() << "needs a larger net.core.rmem_max: this host grants "
                 << rig.source.receive_buffer_bytes() << " bytes";
  }
  const UdpSender sender;
  for (std::uint32_t i = 0; i < kBurst; ++i) {
    sender.send(kHere, rig.data_port, DataPacket().timestamp(i).bytes());
  }
  ASSERT_TRUE(rig.receive_datagrams(kBurst));
  ASSERT_EQ(rig.sink.batches.size(), kBurst);
  for (std::uint32_t i = 0; i < kBurst; ++i) {
    ASSERT_EQ(rig.sink.batches[i].first_firing.count, i);
  }
  EXPECT_EQ(rig.source.counters().datagrams.value(), kBurst);
  EXPECT_EQ(rig.source.counters().kernel_drops.value(), 0U);
  EXPECT_EQ(rig.source.counters().batches.value(),
            (kBurst + DatagramBatch::kCapacity - 1) / DatagramBatch::kCapacity);
}

TEST(UdpSource, WhatComesWhileItGathersIsTakenTogether) {
  constexpr std::chrono::milliseconds kGather{500};  // much more than the sender needs
  UdpRig rig({}, std::nullopt, kGather);
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  const UdpSender sender;
  sender.send(kHere, rig.data_port, DataPacket().timestamp(1).bytes());
  ASSERT_TRUE(rig.receive_datagrams(1));
  std::thread later([&] {
    for (std::uint32_t i = 2; i <= 4; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
      sender.send(kHere, rig.data_port, DataPacket().timestamp(i).bytes());
    }
  });
  rig.source.receive(2 * kGather);
  later.join();
  EXPECT_EQ(rig.source.counters().datagrams.value(), 4U);
  EXPECT_EQ(rig.source.counters().batches.value(), 2U);
}

TEST(UdpSource, DatagramsThatTheKernelDroppedAreCountedToTheLast) {
  constexpr std::uint64_t kSent = 300;
  UdpRig rig({.receive_buffer_bytes = 8192});
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  const UdpSender sender;
  for (std::uint64_t i = 0; i < kSent; ++i) {
    sender.send(kHere, rig.data_port, DataPacket().bytes());
  }
  const UdpCounters& counters = rig.source.counters();
  EXPECT_TRUE(rig.receive_until(
      [&] { return counters.datagrams.value() + counters.kernel_drops.value() >= kSent; }));
  EXPECT_EQ(counters.datagrams.value() + counters.kernel_drops.value(), kSent);
  EXPECT_GT(counters.kernel_drops.value(), 0U);
  // A later datagram carries the count in once more.
  sender.send(kHere, rig.data_port, DataPacket().bytes());
  ASSERT_TRUE(rig.receive_datagrams(kSent + 1 - counters.kernel_drops.value()));
  EXPECT_EQ(counters.datagrams.value() + counters.kernel_drops.value(), kSent + 1);
}

TEST(UdpSource, OversizedDatagramIsCountedAndRefusedByItsLength) {
  UdpRig rig;
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  UdpSender().send(kHere, rig.data_port, std::vector<std::byte>(3000));
  UdpSender().send(kHere, rig.data_port, std::vector<std::byte>(DatagramBatch::kMaxPayload));
  ASSERT_TRUE(rig.receive_datagrams(2));
  EXPECT_EQ(rig.source.counters().truncated.value(), 1U);
  EXPECT_EQ(rig.driver.counters().wrong_length.value(), 2U);
  EXPECT_TRUE(rig.sink.batches.empty());
}

TEST(UdpSource, EmptyDatagramIsRefusedAndTheNextOneReceived) {
  UdpRig rig;
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  UdpSender().send(kHere, rig.data_port, {});
  UdpSender().send(kHere, rig.data_port, DataPacket().bytes());
  ASSERT_TRUE(rig.receive_datagrams(2));
  EXPECT_EQ(rig.driver.counters().wrong_length.value(), 1U);
  EXPECT_EQ(rig.sink.batches.size(), 1U);
}

TEST(UdpSource, OnlyTheConfiguredSenderIsTaken) {
  UdpRig rig({}, Ipv4Address::from_octets(127, 0, 0, 2));
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  UdpSender sensor;
  sensor.from("127.0.0.2");
  UdpSender stranger;
  stranger.from("127.0.0.3");
  stranger.send(kHere, rig.data_port, DataPacket().bytes());
  sensor.send(kHere, rig.data_port, DataPacket().bytes());
  ASSERT_TRUE(rig.receive_datagrams(2));
  EXPECT_EQ(rig.driver.counters().foreign.value(), 1U);
  EXPECT_EQ(rig.driver.counters().data_packets.value(), 1U);
}

TEST(UdpSource, TapHearsEveryDatagramAsItCame) {
  UdpRig rig;
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  UdpSender sender;
  sender.from("127.0.0.2");
  sender.send(kHere, rig.data_port, std::vector<std::byte>(17, std::byte{9}));
  ASSERT_TRUE(rig.receive_datagrams(1));
  ASSERT_EQ(rig.tap.heard.size(), 1U);
  const auto& [record, payload] = rig.tap.heard[0];
  EXPECT_EQ(record.kind, capture::RecordKind::datagram);
  EXPECT_EQ(record.destination_port, rig.data_port);
  EXPECT_NE(record.source_port, 0);
  EXPECT_EQ(record.source, Ipv4Address::from_octets(127, 0, 0, 2));
  EXPECT_EQ(record.destination, Ipv4Address::from_octets(127, 0, 0, 1));
  EXPECT_EQ(payload, std::vector<std::byte>(17, std::byte{9}));
}

TEST(UdpSource, ReceiveBufferIsWhatWasAskedForWhereTheHostAllowsIt) {
  UdpRig rig({.receive_buffer_bytes = 100'000});
  EXPECT_EQ(rig.source.receive_buffer_bytes(), 0U);
  ASSERT_TRUE(rig.link_becomes(live::LinkState::open));
  EXPECT_EQ(rig.source.receive_buffer_bytes(), 100'000U);
}

TEST(UdpSource, AddressThatTheHostDoesNotHaveYetIsBound) {
  UdpRig rig({.local_address = Ipv4Address::from_octets(192, 0, 2, 1)});
  EXPECT_TRUE(rig.link_becomes(live::LinkState::open));
  EXPECT_EQ(rig.source.last_error(), 0);
}

TEST(UdpSource, PortInUseIsTriedAgainUntilItIsFree) {
  UdpRig rig;
  {
    // A program that does not share its port.
    live::FileDescriptor holder(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(rig.position_port);
    ASSERT_EQ(::bind(holder.get(), reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    ASSERT_TRUE(rig.receive_until([&] { return rig.source.last_error() == EADDRINUSE; }));
    EXPECT_EQ(rig.source.link(), live::LinkState::closed);
  }
  EXPECT_TRUE(rig.link_becomes(live::LinkState::open));
  EXPECT_EQ(rig.source.last_error(), 0);
  EXPECT_EQ(rig.source.counters().opened.value(), 1U);
}

TEST(UdpSource, PortIsSharedWithAnotherProgramThatSharesIt) {
  UdpRig first;
  ASSERT_TRUE(first.link_becomes(live::LinkState::open));
  UdpSocket second;
  EXPECT_EQ(second.open({}, first.data_port), 0);
}

TEST(UdpSource, MissingInterfaceIsTheErrorOfTheLink) {
  UdpRig rig({.interface = "no-such-if0"});
  EXPECT_TRUE(rig.receive_until([&] { return rig.source.last_error() == ENODEV; }));
  EXPECT_EQ(rig.source.link(), live::LinkState::closed);
}

}  // namespace
}  // namespace convexcut::udp
