// SPDX-License-Identifier: Apache-2.0
//
// Which datagrams are data packets, and in which return mode they are. Does not prove: that the
// rule for implausible mode bytes holds for firmware that nobody has a recording of.
#include "drivers/velodyne/data_packet.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/velodyne/packets.hpp"

namespace convexcut::velodyne {
namespace {

using test::DataPacket;

TEST(CheckDataPacket, AzimuthThirtySixThousandIsAcceptedAndOneMoreIsNot) {
  EXPECT_EQ(check_data_packet(DataPacket().azimuth(5, 36000).bytes()), DecodeStatus::ok);
  EXPECT_EQ(check_data_packet(DataPacket().azimuth(5, 36001).bytes()),
            DecodeStatus::azimuth_out_of_range);
  EXPECT_EQ(check_data_packet(DataPacket().azimuth(11, 0xFFFF).bytes()),
            DecodeStatus::azimuth_out_of_range);
}

TEST(CheckDataPacket, EveryBlockMustStartWithTheUpperBankFlag) {
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(check_data_packet(DataPacket().flag(block, 0xFF, 0xDD).bytes()),
              DecodeStatus::wrong_block_flag);
    EXPECT_EQ(check_data_packet(DataPacket().flag(block, 0xEE, 0xFF).bytes()),
              DecodeStatus::wrong_block_flag);
  }
}

TEST(CheckDataPacket, TimestampMayRunASecondPastTheHour) {
  EXPECT_EQ(check_data_packet(DataPacket().timestamp(3'601'000'000).bytes()), DecodeStatus::ok);
  EXPECT_EQ(check_data_packet(DataPacket().timestamp(3'601'000'001).bytes()),
            DecodeStatus::timestamp_out_of_range);
  EXPECT_EQ(check_data_packet(DataPacket().timestamp(0xFFFFFFFF).bytes()),
            DecodeStatus::timestamp_out_of_range);
}

TEST(CheckDataPacket, ModeAndProductBytesAreNoReasonToReject) {
  for (unsigned byte = 0; byte < 256; ++byte) {
    const auto value = static_cast<std::uint8_t>(byte);
    EXPECT_EQ(check_data_packet(DataPacket().mode(value).product(0xFF).bytes()), DecodeStatus::ok);
    EXPECT_EQ(check_data_packet(DataPacket().product(value).bytes()), DecodeStatus::ok);
  }
}

TEST(Timestamp, OvershootContinuesInTheNextHour) {
  EXPECT_EQ(timestamp(DataPacket().timestamp(3'599'999'999).bytes()).count, 3'599'999'999U);
  EXPECT_EQ(timestamp(DataPacket().timestamp(3'600'000'000).bytes()).count, 0U);
  EXPECT_EQ(timestamp(DataPacket().timestamp(3'600'000'123).bytes()).count, 123U);
}

TEST(DualReturns, PlausibleModeByteDecides) {
  EXPECT_FALSE(has_dual_returns(DataPacket().mode(0x37).bytes()));
  EXPECT_FALSE(has_dual_returns(DataPacket().mode(0x38).bytes()));
  EXPECT_TRUE(has_dual_returns(DataPacket().mode(0x39).bytes()));
}

TEST(DualReturns, StoppedRotorInSingleModeIsNotDual) {
  EXPECT_FALSE(has_dual_returns(DataPacket().azimuths(7000, 0).mode(0x37).bytes()));
  EXPECT_TRUE(has_dual_returns(DataPacket().azimuths(7000, 0).mode(0x39).bytes()));
}

TEST(DualReturns, ImplausibleBytesLeaveItToEqualAzimuths) {
  EXPECT_TRUE(has_dual_returns(DataPacket().azimuths(35980, 16, 2).mode(0).product(0).bytes()));
  EXPECT_FALSE(has_dual_returns(DataPacket().azimuths(35980, 16, 1).mode(0).product(0).bytes()));
}

TEST(DualReturns, ImplausibleProductMakesTheModeByteImplausible) {
  EXPECT_FALSE(has_dual_returns(DataPacket().mode(0x39).product(0x77).bytes()));
  EXPECT_TRUE(has_dual_returns(DataPacket().azimuths(0, 16, 2).mode(0x37).product(0x77).bytes()));
}

TEST(DualReturns, ImplausibleBytesAtAStandstillAreSingle) {
  EXPECT_FALSE(has_dual_returns(DataPacket().azimuths(7000, 0).mode(0).product(0).bytes()));
}

// Half a centidegree a block: neighbours round to pairs by chance.
TEST(DualReturns, ImplausibleBytesOfACreepingRotorAreSingle) {
  EXPECT_FALSE(has_dual_returns(DataPacket().azimuths(7000, 1, 2).mode(0).product(0).bytes()));
}

TEST(DualReturns, ImplausibleBytesWithOneUnequalPairAreSingle) {
  const DataPacket packet = DataPacket().azimuths(0, 16, 2).azimuth(11, 81).mode(0).product(0);
  EXPECT_FALSE(has_dual_returns(packet.bytes()));
}

}  // namespace
}  // namespace convexcut::velodyne
