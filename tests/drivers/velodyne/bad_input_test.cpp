// SPDX-License-Identifier: Apache-2.0
//
// Datagrams of every length, and bytes flipped one by one: rejected by reason, without a point and
// without a write. Does not prove: the absence of reads out of bounds, for which these tests run
// under AddressSanitizer and the decoders under a fuzzer.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/velodyne/lidar_driver.hpp"
#include "tests/drivers/velodyne/collecting_sink.hpp"
#include "tests/drivers/velodyne/packets.hpp"

namespace convexcut::velodyne {
namespace {

using test::CollectingSink;
using test::DataPacket;
using test::PositionDatagram;

constexpr std::size_t kLongest = 1500;

// The first bytes of `packet`, or it and 0xFF after it, in an allocation of just that size, so that
// a sanitizer sees any read beyond it.
std::vector<std::byte> resized(std::span<const std::byte> packet, std::size_t length) {
  std::vector<std::byte> bytes(length, std::byte{0xFF});
  std::copy_n(packet.begin(), std::min(length, packet.size()), bytes.begin());
  bytes.shrink_to_fit();
  return bytes;
}

// Whether a decode of `payload` leaves every byte of the batch as it was.
bool leaves_batch_alone(std::span<const std::byte> payload, DecodeStatus expected) {
  static_assert(std::is_trivially_copyable_v<ReturnBatch>);
  const auto batch = std::make_unique<ReturnBatch>();
  const std::vector<unsigned char> before(sizeof(ReturnBatch), 0xA5);
  std::memcpy(static_cast<void*>(batch.get()), before.data(), before.size());
  EXPECT_EQ(DataDecoder(model_of(ModelId::hdl32e)).decode(payload, HostTime{}, *batch), expected);
  return std::memcmp(batch.get(), before.data(), before.size()) == 0;
}

DataPacket full_packet() {
  DataPacket packet;
  for (std::size_t block = 0; block < 12; ++block) {
    for (std::size_t slot = 0; slot < 32; ++slot) packet.echo(block, slot, 5000, 1);
  }
  return packet;
}

TEST(DataDatagram, IsAcceptedAtItsOneLengthOfAll) {
  const DataPacket packet = full_packet();
  for (std::size_t length = 0; length <= kLongest; ++length) {
    CollectingSink sink;
    LidarDriver driver({.model = ModelId::hdl32e}, sink);
    driver.on_datagram(resized(packet.bytes(), length), 2368, HostTime{});
    const bool right = length == 1206;
    ASSERT_EQ(sink.batches.size(), right ? 1U : 0U) << length;
    ASSERT_EQ(driver.counters().data_packets.value(), right ? 1U : 0U) << length;
    ASSERT_EQ(driver.counters().wrong_length.value(), right ? 0U : 1U) << length;
    ASSERT_EQ(driver.counters().returns.value(), right ? 384U : 0U) << length;
  }
}

TEST(PositionDatagram, IsAcceptedAtItsOneLengthOfAll) {
  const PositionDatagram packet = PositionDatagram().pps(2);
  for (std::size_t length = 0; length <= kLongest; ++length) {
    CollectingSink sink;
    LidarDriver driver({.model = ModelId::hdl32e}, sink);
    driver.on_datagram(resized(packet.bytes(), length), 8308, HostTime{});
    const bool right = length == 512;
    ASSERT_EQ(driver.counters().position_packets.value(), right ? 1U : 0U) << length;
    ASSERT_EQ(driver.counters().wrong_length.value(), right ? 0U : 1U) << length;
    ASSERT_EQ(driver.position().has_value(), right) << length;
    ASSERT_TRUE(sink.batches.empty());
  }
}

TEST(DataDatagram, OnThePositionPortIsOfTheWrongLength) {
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  driver.on_datagram(full_packet().bytes(), 8308, HostTime{});
  driver.on_datagram(PositionDatagram().bytes(), 2368, HostTime{});
  EXPECT_EQ(driver.counters().wrong_length.value(), 2U);
  EXPECT_TRUE(sink.batches.empty());
}

TEST(ForeignDatagram, OnAnyOtherPortIsCountedWhateverItHolds) {
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  for (const unsigned port : {0U, 443U, 2367U, 2369U, 8307U, 8309U, 65535U}) {
    driver.on_datagram(full_packet().bytes(), static_cast<std::uint16_t>(port), HostTime{});
  }
  EXPECT_EQ(driver.counters().foreign.value(), 7U);
  EXPECT_TRUE(sink.batches.empty());
}

TEST(Decoder, EveryTruncationLeavesTheBatchAlone) {
  const DataPacket packet = full_packet();
  for (std::size_t length = 0; length < 1206; ++length) {
    ASSERT_TRUE(leaves_batch_alone(resized(packet.bytes(), length), DecodeStatus::wrong_length))
        << length;
  }
}

TEST(Decoder, EveryOtherRejectionLeavesTheBatchAlone) {
  EXPECT_TRUE(leaves_batch_alone(full_packet().flag(11, 0xFF, 0xDD).bytes(),
                                 DecodeStatus::wrong_block_flag));
  EXPECT_TRUE(leaves_batch_alone(full_packet().azimuth(11, 36001).bytes(),
                                 DecodeStatus::azimuth_out_of_range));
  EXPECT_TRUE(leaves_batch_alone(full_packet().timestamp(0xFFFFFFFF).bytes(),
                                 DecodeStatus::timestamp_out_of_range));
}

TEST(Decoder, AcceptedPacketDoesChangeTheBatch) {
  EXPECT_FALSE(leaves_batch_alone(full_packet().bytes(), DecodeStatus::ok));
}

// Any one byte of a good packet changed: accepted or rejected, never inconsistent.
TEST(LidarDriver, SurvivesAnyOneWrongByte) {
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  const DataPacket good = full_packet();
  std::size_t sent = 0;
  for (std::size_t at = 0; at < 1206; ++at) {
    for (const unsigned bits : {0x01U, 0x80U, 0xFFU}) {
      std::vector<std::byte> bytes = resized(good.bytes(), 1206);
      bytes[at] ^= static_cast<std::byte>(bits);
      driver.on_datagram(bytes, 2368, HostTime{});
      ++sent;
    }
  }
  const LidarCounters& counters = driver.counters();
  EXPECT_EQ(counters.data_packets.value() + counters.wrong_block_flag.value() +
                counters.azimuth_out_of_range.value() + counters.timestamp_out_of_range.value(),
            sent);
  EXPECT_EQ(counters.wrong_block_flag.value(), 12U * 2 * 3);
  EXPECT_EQ(counters.data_packets.value(), sink.batches.size());
}

}  // namespace
}  // namespace convexcut::velodyne
