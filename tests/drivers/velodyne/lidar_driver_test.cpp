// SPDX-License-Identifier: Apache-2.0
//
// Dispatch, holding until the model is known, clock offset and counters. Does not prove: that the
// counters are readable from other threads without a race (core/counter.hpp).
#include "drivers/velodyne/lidar_driver.hpp"

#include <chrono>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/drivers/velodyne/collecting_sink.hpp"
#include "tests/drivers/velodyne/packets.hpp"

namespace convexcut::velodyne {
namespace {

using namespace std::chrono_literals;
using test::CollectingSink;
using test::DataPacket;
using test::PositionDatagram;

constexpr std::uint16_t kData = 2368;
constexpr std::uint16_t kPosition = 8308;

HostTime at(int packet) { return from_ns<HostTime>(1'000'000'000 + packet * 552'960); }

// The n-th packet of an HDL-32E, with one return.
DataPacket hdl32e_packet(int n) {
  return DataPacket().timestamp(static_cast<std::uint32_t>(1000 + n * 553)).echo(0, 15, 5000);
}

TEST(LidarDriver, ConfiguredModelDecodesAtOnce) {
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::vlp16}, sink);
  EXPECT_EQ(driver.model(), ModelId::vlp16);
  driver.on_datagram(hdl32e_packet(0).bytes(), kData, at(0));
  ASSERT_EQ(sink.batches.size(), 1U);
  EXPECT_EQ(sink.batches[0].firing_count, 24);
  EXPECT_EQ(sink.batches[0].arrival, at(0));
  EXPECT_EQ(driver.counters().product_differs.value(), 1U);
}

TEST(LidarDriver, PacketsHeldUntilTheModelIsKnownAreAllDecodedInOrder) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  for (int n = 0; n < 3; ++n) driver.on_datagram(hdl32e_packet(n).bytes(), kData, at(n));
  EXPECT_FALSE(driver.model().has_value());
  EXPECT_TRUE(sink.batches.empty());
  for (int n = 3; n < 6; ++n) driver.on_datagram(hdl32e_packet(n).bytes(), kData, at(n));
  EXPECT_EQ(driver.model(), ModelId::hdl32e);
  ASSERT_EQ(sink.batches.size(), 6U);
  for (int n = 0; n < 6; ++n) {
    const ReturnBatch& batch = sink.batches[static_cast<std::size_t>(n)];
    EXPECT_EQ(batch.arrival, at(n));
    EXPECT_EQ(batch.first_firing.count, static_cast<std::uint32_t>(1000 + n * 553));
    EXPECT_EQ(batch.return_count, 1);
  }
  EXPECT_EQ(driver.counters().data_packets.value(), 6U);
  EXPECT_EQ(driver.counters().returns.value(), 6U);
}

TEST(LidarDriver, HeldPacketsKeepThePpsStateOfTheirArrival) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  driver.on_datagram(hdl32e_packet(0).bytes(), kData, at(0));
  driver.on_datagram(PositionDatagram().pps(2).bytes(), kPosition, at(0));
  for (int n = 1; n < 4; ++n) driver.on_datagram(hdl32e_packet(n).bytes(), kData, at(n));
  ASSERT_EQ(sink.batches.size(), 4U);
  EXPECT_EQ(sink.batches[0].pps, PpsState::unknown);
  EXPECT_EQ(sink.batches[1].pps, PpsState::locked);
}

TEST(LidarDriver, FlushDecidesWithWhatThereIs) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  driver.on_datagram(hdl32e_packet(0).bytes(), kData, at(0));
  driver.flush();
  EXPECT_EQ(driver.model(), ModelId::hdl32e);
  EXPECT_EQ(sink.batches.size(), 1U);
}

TEST(LidarDriver, FlushWithoutPacketsDecidesNothing) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  driver.flush();
  EXPECT_FALSE(driver.model().has_value());
  EXPECT_TRUE(sink.batches.empty());
}

TEST(LidarDriver, FlushTwiceDecodesOnce) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  driver.on_datagram(hdl32e_packet(0).bytes(), kData, at(0));
  driver.flush();
  driver.flush();
  EXPECT_EQ(sink.batches.size(), 1U);
}

TEST(LidarDriver, PacketsOfNoKnownModelAreCountedAndTheNextOnesTried) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  for (int n = 0; n < 8; ++n) {
    driver.on_datagram(DataPacket().mode(0).product(0).timestamp(5).bytes(), kData, at(n));
  }
  EXPECT_FALSE(driver.model().has_value());
  EXPECT_EQ(driver.counters().model_unknown.value(), 8U);
  EXPECT_TRUE(sink.batches.empty());
  for (int n = 8; n < 12; ++n) driver.on_datagram(hdl32e_packet(n).bytes(), kData, at(n));
  EXPECT_EQ(driver.model(), ModelId::hdl32e);
  EXPECT_EQ(sink.batches.size(), 4U);
}

TEST(LidarDriver, EvidenceOfDroppedPacketsIsForgotten) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  DataPacket packet = DataPacket().mode(0).product(0);
  std::uint32_t micros = 0;
  for (int n = 0; n < 8; ++n) {  // two sensors' steps in turn contradict each other
    driver.on_datagram(packet.timestamp(micros).bytes(), kData, at(n));
    micros += n % 2 == 0 ? 553U : 1327U;
  }
  EXPECT_EQ(driver.counters().model_unknown.value(), 8U);
  for (int n = 8; n < 12; ++n) {
    driver.on_datagram(packet.timestamp(micros).bytes(), kData, at(n));
    micros += 553;
  }
  EXPECT_EQ(driver.model(), ModelId::hdl32e);
}

TEST(LidarDriver, FlushCountsPacketsOfNoKnownModel) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  driver.on_datagram(DataPacket().mode(0).product(0).bytes(), kData, at(0));
  driver.flush();
  EXPECT_FALSE(driver.model().has_value());
  EXPECT_EQ(driver.counters().model_unknown.value(), 1U);
}

TEST(LidarDriver, EightPacketsWithoutUsableTimesAreDecodedByTheirProductByte) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  for (int n = 0; n < 8; ++n) {
    driver.on_datagram(DataPacket().product(0x24).timestamp(5).bytes(), kData, at(n));
  }
  EXPECT_EQ(driver.model(), ModelId::puck_hires);
  EXPECT_EQ(sink.batches.size(), 8U);
}

TEST(LidarDriver, LyingProductByteIsCountedAndHasNoOtherEffect) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  for (int n = 0; n < 4; ++n) {  // a VLP-16 of 2014
    const auto micros = static_cast<std::uint32_t>(1000 + n * 1327);
    driver.on_datagram(DataPacket().timestamp(micros).product(0x21).bytes(), kData, at(n));
  }
  EXPECT_EQ(driver.model(), ModelId::vlp16);
  EXPECT_EQ(driver.counters().product_differs.value(), 4U);
}

TEST(LidarDriver, PortsAreConfigurable) {
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e, .data_port = 4000, .position_port = 4001}, sink);
  driver.on_datagram(hdl32e_packet(0).bytes(), 4000, at(0));
  driver.on_datagram(PositionDatagram().bytes(), 4001, at(0));
  driver.on_datagram(hdl32e_packet(0).bytes(), kData, at(0));
  EXPECT_EQ(driver.counters().data_packets.value(), 1U);
  EXPECT_EQ(driver.counters().position_packets.value(), 1U);
  EXPECT_EQ(driver.counters().foreign.value(), 1U);
}

TEST(LidarDriver, WithAConfiguredSenderOthersAreForeign) {
  constexpr Ipv4Address kSensor{0xC0A801C9};  // 192.168.1.201
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e, .from = kSensor}, sink);
  driver.on_datagram(hdl32e_packet(0).bytes(), kData, at(0), kSensor);
  driver.on_datagram(hdl32e_packet(1).bytes(), kData, at(1), Ipv4Address{0xC0A801CA});
  driver.on_datagram(hdl32e_packet(2).bytes(), kData, at(2));
  driver.on_datagram(PositionDatagram().bytes(), kPosition, at(2), Ipv4Address{0xC0A801CA});
  EXPECT_EQ(driver.counters().data_packets.value(), 1U);
  EXPECT_EQ(driver.counters().position_packets.value(), 0U);
  EXPECT_EQ(driver.counters().foreign.value(), 3U);
}

TEST(LidarDriver, WithoutAConfiguredSenderAllAreTaken) {
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  driver.on_datagram(hdl32e_packet(0).bytes(), kData, at(0), Ipv4Address{0xC0A811A2});
  EXPECT_EQ(driver.counters().data_packets.value(), 1U);
}

TEST(LidarDriver, PpsIsUnknownUntilThePositionPacketSaysIt) {
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  driver.on_datagram(hdl32e_packet(0).bytes(), kData, at(0));
  driver.on_datagram(PositionDatagram().pps(1).bytes(), kPosition, at(0));
  driver.on_datagram(hdl32e_packet(1).bytes(), kData, at(1));
  driver.on_datagram(PositionDatagram().pps(2).bytes(), kPosition, at(1));
  driver.on_datagram(hdl32e_packet(2).bytes(), kData, at(2));
  EXPECT_EQ(sink.batches[0].pps, PpsState::unknown);
  EXPECT_EQ(sink.batches[1].pps, PpsState::synchronising);
  EXPECT_EQ(sink.batches[2].pps, PpsState::locked);
  EXPECT_EQ(driver.position()->pps, PpsState::locked);
}

TEST(LidarDriver, ABadPositionPacketLeavesTheLastGoodOne) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  driver.on_datagram(PositionDatagram().pps(2).bytes(), kPosition, at(0));
  driver.on_datagram(PositionDatagram().pps(3).sentence("garbage").bytes(), kPosition, at(0));
  driver.on_datagram(PositionDatagram().pps(3).timestamp(~0U).bytes(), kPosition, at(0));
  EXPECT_EQ(driver.position()->pps, PpsState::locked);
  EXPECT_EQ(driver.counters().position_packets.value(), 1U);
  EXPECT_EQ(driver.counters().no_sentence.value(), 1U);
  EXPECT_EQ(driver.counters().timestamp_out_of_range.value(), 1U);
}

TEST(LidarDriver, BrokenSentencesAreCountedAndAbsentOnesNot) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  driver.on_datagram(PositionDatagram().bytes(), kPosition, at(0));
  driver.on_datagram(PositionDatagram().sentence("$GPRMC,,V*00").bytes(), kPosition, at(0));
  EXPECT_EQ(driver.counters().position_packets.value(), 2U);
  EXPECT_EQ(driver.counters().bad_nmea.value(), 1U);
}

std::uint32_t shifted(std::uint32_t micros, Duration offset) {
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e, .time_offset = offset}, sink);
  driver.on_datagram(DataPacket().timestamp(micros).bytes(), kData, at(0));
  return sink.batches.at(0).first_firing.count;
}

TEST(LidarDriver, TimeOffsetShiftsModuloTheHour) {
  EXPECT_EQ(shifted(1000, 0ns), 1000U);
  EXPECT_EQ(shifted(1000, 500us), 1500U);
  EXPECT_EQ(shifted(3'599'999'999, 1us), 0U);
  EXPECT_EQ(shifted(0, -1us), 3'599'999'999U);
  EXPECT_EQ(shifted(1000, 24h), 1000U);
  EXPECT_EQ(shifted(1000, -25h), 1000U);
}

// Appendix E of the manual: the timestamp is that of the end of the packet.
TEST(LidarDriver, TimeOffsetIsRoundedToTheMicrosecond) {
  EXPECT_EQ(shifted(1000, -542'592ns), 457U);
}

TEST(LidarDriver, TimeOffsetAppliesToAnOvershootingClock) {
  EXPECT_EQ(shifted(3'600'000'010, -20us), 3'599'999'990U);
}

TEST(LidarDriver, AFullSinkIsCountedAndDecodingGoesOn) {
  CollectingSink sink(2);
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  for (int n = 0; n < 5; ++n) driver.on_datagram(hdl32e_packet(n).bytes(), kData, at(n));
  EXPECT_EQ(sink.batches.size(), 2U);
  EXPECT_EQ(driver.counters().data_packets.value(), 2U);
  EXPECT_EQ(driver.counters().sink_full.value(), 3U);
  EXPECT_EQ(driver.counters().returns.value(), 2U);
}

TEST(LidarDriver, BadDataPacketsClaimNoSlot) {
  class NeverAsked final : public Sink<ReturnBatch> {
   public:
    ReturnBatch* claim() noexcept override {
      ++claims;
      return nullptr;
    }
    void commit() noexcept override {}
    int claims = 0;
  };
  NeverAsked sink;
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  driver.on_datagram(DataPacket().flag(3, 0xFF, 0xDD).bytes(), kData, at(0));
  driver.on_datagram(DataPacket().azimuth(3, 36001).bytes(), kData, at(0));
  EXPECT_EQ(sink.claims, 0);
  EXPECT_EQ(driver.counters().wrong_block_flag.value(), 1U);
  EXPECT_EQ(driver.counters().azimuth_out_of_range.value(), 1U);
}

TEST(LidarDriver, BadPacketsWhileTheModelIsUnknownAreNotHeld) {
  CollectingSink sink;
  LidarDriver driver({}, sink);
  for (int n = 0; n < 20; ++n) {
    driver.on_datagram(DataPacket().azimuth(0, 36001).bytes(), kData, at(n));
  }
  driver.flush();
  EXPECT_FALSE(driver.model().has_value());
  EXPECT_EQ(driver.counters().azimuth_out_of_range.value(), 20U);
  EXPECT_EQ(driver.counters().model_unknown.value(), 0U);
}

}  // namespace
}  // namespace convexcut::velodyne
