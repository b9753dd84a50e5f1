// SPDX-License-Identifier: Apache-2.0
//
// Does not prove: which axes the motion sensors have (undocumented), nor what old firmware means by
// a PPS state of 0.
#include "drivers/velodyne/position_packet.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/drivers/velodyne/packets.hpp"

namespace convexcut::velodyne {
namespace {

using test::PositionDatagram;

PositionPacket decode(const PositionDatagram& datagram) {
  PositionPacket packet;
  EXPECT_EQ(decode_position_packet(datagram.bytes(), packet), PositionStatus::ok);
  return packet;
}

PositionDatagram with_motion(std::size_t set, std::uint16_t gyro, std::uint16_t temperature,
                             std::uint16_t accel_x, std::uint16_t accel_y) {
  const std::size_t at = 14 + 8 * set;
  return PositionDatagram()
      .word(at, gyro)
      .word(at + 2, temperature)
      .word(at + 4, accel_x)
      .word(at + 6, accel_y);
}

// The worked examples of the manual.
TEST(PositionPacket, MotionWordsAreAsTheManualsExamples) {
  for (std::size_t set = 0; set < 3; ++set) {
    const PositionPacket packet = decode(with_motion(set, 0x0FDE, 0x1055, 0x231B, 0x3009));
    ASSERT_TRUE(packet.motion[set].has_value()) << set;
    EXPECT_NEAR(packet.motion[set]->rate_deg_s, -3.32, 0.005);
    EXPECT_NEAR(packet.motion[set]->temperature_c, 37.35, 0.005);
    EXPECT_NEAR(packet.motion[set]->acceleration_x_g, 0.97, 0.005);
    EXPECT_NEAR(packet.motion[set]->acceleration_y_g, 0.011, 0.0005);
    EXPECT_EQ(std::ranges::count_if(packet.motion, [](const auto& m) { return m.has_value(); }), 1);
  }
}

TEST(PositionPacket, MotionValuesAreTwelveBitTwosComplement) {
  const PositionPacket packet = decode(with_motion(0, 0x0800, 0x17FF, 0x2FFF, 0x3000));
  EXPECT_FLOAT_EQ(packet.motion[0]->rate_deg_s, -2048 * 0.09766F);
  EXPECT_FLOAT_EQ(packet.motion[0]->temperature_c, 2047 * 0.1453F + 25.0F);
  EXPECT_FLOAT_EQ(packet.motion[0]->acceleration_x_g, -0.001221F);
  EXPECT_FLOAT_EQ(packet.motion[0]->acceleration_y_g, 0.0F);
}

TEST(PositionPacket, ZeroWordsOfAVlp16AreNoMotionSensor) {
  const PositionPacket packet = decode(PositionDatagram());
  EXPECT_TRUE(std::ranges::none_of(packet.motion, [](const auto& m) { return m.has_value(); }));
}

TEST(PositionPacket, WordsWithTheTagOfAnotherAreNoMotionSensor) {
  EXPECT_FALSE(decode(with_motion(0, 0x1FDE, 0x1055, 0x231B, 0x3009)).motion[0].has_value());
  EXPECT_FALSE(decode(with_motion(0, 0x0FDE, 0x0055, 0x231B, 0x3009)).motion[0].has_value());
  EXPECT_FALSE(decode(with_motion(0, 0x0FDE, 0x1055, 0x331B, 0x3009)).motion[0].has_value());
  EXPECT_FALSE(decode(with_motion(0, 0x0FDE, 0x1055, 0x231B, 0x2009)).motion[0].has_value());
}

TEST(PositionPacket, PpsByteIsTheState) {
  EXPECT_EQ(decode(PositionDatagram().pps(0)).pps, PpsState::absent);
  EXPECT_EQ(decode(PositionDatagram().pps(1)).pps, PpsState::synchronising);
  EXPECT_EQ(decode(PositionDatagram().pps(2)).pps, PpsState::locked);
  EXPECT_EQ(decode(PositionDatagram().pps(3)).pps, PpsState::error);
  EXPECT_EQ(decode(PositionDatagram().pps(4)).pps, PpsState::unknown);
  EXPECT_EQ(decode(PositionDatagram().pps(255)).pps, PpsState::unknown);
}

TEST(PositionPacket, TimestampIsReducedToTheHour) {
  EXPECT_EQ(decode(PositionDatagram().timestamp(1'082'725'066)).time.count, 1'082'725'066U);
  EXPECT_EQ(decode(PositionDatagram().timestamp(3'600'000'001)).time.count, 1U);
}

TEST(PositionPacket, TimestampFarPastTheHourIsRejected) {
  PositionPacket packet;
  EXPECT_EQ(decode_position_packet(PositionDatagram().timestamp(3'601'000'001).bytes(), packet),
            PositionStatus::timestamp_out_of_range);
}

TEST(PositionPacket, SentenceIsParsed) {
  const PositionPacket packet = decode(PositionDatagram().sentence(
      "$GPRMC,081802.00,A,3649.7478558,N,00224.4542928,W,0.034,212.5,210116,0.0,E,A*2E\r\n"));
  EXPECT_EQ(packet.nmea_status, NmeaStatus::ok);
  EXPECT_TRUE(packet.fix.valid);
}

TEST(PositionPacket, WithoutReceiverTheSentenceIsAbsent) {
  EXPECT_EQ(decode(PositionDatagram()).nmea_status, NmeaStatus::absent);
}

TEST(PositionPacket, ABrokenSentenceDoesNotSpoilThePacket) {
  const PositionPacket packet = decode(PositionDatagram().pps(2).sentence("$GPRMC,0818"));
  EXPECT_EQ(packet.nmea_status, NmeaStatus::bad_checksum);
  EXPECT_EQ(packet.pps, PpsState::locked);
}

TEST(PositionPacket, OtherTextWhereTheSentenceStartsIsNoPositionPacket) {
  PositionPacket packet;
  packet.pps = PpsState::error;
  EXPECT_EQ(decode_position_packet(PositionDatagram().sentence("GPRMC").pps(2).bytes(), packet),
            PositionStatus::no_sentence);
  EXPECT_EQ(packet.pps, PpsState::error);
}

TEST(PositionPacket, SentenceMayFillItsFieldToTheLastByte) {
  EXPECT_EQ(decode(PositionDatagram().sentence("$" + std::string(305, 'A'))).nmea_status,
            NmeaStatus::bad_checksum);
}

}  // namespace
}  // namespace convexcut::velodyne
