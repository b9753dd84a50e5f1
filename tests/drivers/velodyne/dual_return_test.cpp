// SPDX-License-Identifier: Apache-2.0
//
// Dual-return packets. Does not prove: that the HDL-32E orders its echoes as the VLP-16's manual
// says; no recording of either was to be had.
#include <cmath>

#include <gtest/gtest.h>

#include "drivers/velodyne/decoder.hpp"
#include "tests/drivers/velodyne/packets.hpp"

namespace convexcut::velodyne {
namespace {

using test::DataPacket;

DataPacket dual_packet() { return DataPacket().azimuths(10000, 16, 2).mode(test::kDual); }

ReturnBatch decode(const DataPacket& packet, ModelId model = ModelId::hdl32e) {
  ReturnBatch batch;
  EXPECT_EQ(DataDecoder(model_of(model)).decode(packet.bytes(), HostTime{}, batch),
            DecodeStatus::ok);
  return batch;
}

TEST(DualReturn, EvenBlockIsTheLastAndOddBlockTheStrongest) {
  const ReturnBatch batch = decode(dual_packet().echo(0, 15, 9000, 20).echo(1, 15, 4000, 90));
  ASSERT_EQ(batch.return_count, 2);
  EXPECT_EQ(batch.echo[0], Echo::last);
  EXPECT_FLOAT_EQ(batch.range_m[0], 18.0F);
  EXPECT_EQ(batch.intensity[0], 20);
  EXPECT_TRUE(batch.farthest[0]);
  EXPECT_EQ(batch.echo[1], Echo::strongest);
  EXPECT_FLOAT_EQ(batch.range_m[1], 8.0F);
  EXPECT_EQ(batch.intensity[1], 90);
  EXPECT_FALSE(batch.farthest[1]);
}

TEST(DualReturn, FarthestIsByRangeNotByEcho) {
  const ReturnBatch batch = decode(dual_packet().echo(0, 15, 4000).echo(1, 15, 9000));
  ASSERT_EQ(batch.return_count, 2);
  EXPECT_FALSE(batch.farthest[0]);
  EXPECT_TRUE(batch.farthest[1]);
}

TEST(DualReturn, BothEchoesOfAPulseHaveItsDirectionAndTime) {
  const ReturnBatch batch = decode(dual_packet().echo(4, 31, 10000).echo(5, 31, 5000));
  ASSERT_EQ(batch.return_count, 2);
  EXPECT_EQ(batch.offset_ns[0], batch.offset_ns[1]);
  EXPECT_NEAR(batch.x_lidar[0], 2 * batch.x_lidar[1], 1e-5);
  EXPECT_NEAR(batch.y_lidar[0], 2 * batch.y_lidar[1], 1e-5);
  EXPECT_NEAR(batch.z_lidar[0], 2 * batch.z_lidar[1], 1e-5);
}

TEST(DualReturn, IdenticalEchoesAreOneReturn) {
  const ReturnBatch batch = decode(dual_packet().echo(0, 15, 9000, 20).echo(1, 15, 9000, 20));
  ASSERT_EQ(batch.return_count, 1);
  EXPECT_EQ(batch.echo[0], Echo::only);
  EXPECT_TRUE(batch.farthest[0]);
}

TEST(DualReturn, WithoutAStrongestTheLastIsTheOnlyOne) {
  const ReturnBatch batch = decode(dual_packet().echo(0, 15, 9000, 20));
  ASSERT_EQ(batch.return_count, 1);
  EXPECT_EQ(batch.echo[0], Echo::only);
  EXPECT_TRUE(batch.farthest[0]);
}

TEST(DualReturn, WithoutALastTheStrongestIsTheOnlyOne) {
  const ReturnBatch batch = decode(dual_packet().echo(1, 15, 4000, 90));
  ASSERT_EQ(batch.return_count, 1);
  EXPECT_EQ(batch.echo[0], Echo::only);
  EXPECT_TRUE(batch.farthest[0]);
  EXPECT_FLOAT_EQ(batch.range_m[0], 8.0F);
  EXPECT_EQ(batch.intensity[0], 90);
}

TEST(DualReturn, EchoesStayAdjacentInLaserOrder) {
  DataPacket packet = dual_packet();
  for (std::size_t laser = 0; laser < 32; ++laser) {
    packet.echo(0, laser, 9000).echo(1, laser, 4000);
  }
  const ReturnBatch batch = decode(packet);
  ASSERT_EQ(batch.return_count, 64);
  EXPECT_EQ(batch.firings[0].return_count, 64);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_EQ(batch.offset_ns[i], 1'152U * (i / 2));
    EXPECT_EQ(batch.echo[i], i % 2 == 0 ? Echo::last : Echo::strongest);
  }
}

TEST(DualReturn, PacketHoldsSixFiringsOfTheHdl32e) {
  const ReturnBatch batch = decode(dual_packet().echo(10, 31, 9000));
  ASSERT_EQ(batch.firing_count, 6);
  EXPECT_EQ(batch.span(), Duration{276'480});
  EXPECT_EQ(batch.offset_ns[0], 5U * 46'080 + 31 * 1'152);
  EXPECT_EQ(batch.firings[5].azimuth, Azimuth::from_centidegrees(10080));
}

TEST(DualReturn, PacketHoldsTwelveFiringsOfTheVlp16) {
  const ReturnBatch batch =
      decode(dual_packet().product(0x22).echo(10, 31, 9000).echo(11, 31, 4000), ModelId::vlp16);
  ASSERT_EQ(batch.firing_count, 12);
  EXPECT_EQ(batch.firings[1].offset_ns, 55'296U);
  EXPECT_EQ(batch.offset_ns[0], 5U * 110'592 + 55'296 + 15 * 2'304);
  EXPECT_EQ(batch.firings[11].return_count, 2);
}

TEST(DualReturn, AzimuthStepsAreBetweenPairs) {
  const ReturnBatch batch = decode(dual_packet().azimuths(9000, 16, 2).echo(0, 31, 10000));
  const auto x = static_cast<double>(batch.x_lidar[0]);
  const auto y = static_cast<double>(batch.y_lidar[0]);
  const double clockwise_past_right = std::atan2(-x, -y) * 180.0 / M_PI;
  EXPECT_NEAR(clockwise_past_right, 0.16 * 31 / 40, 1e-5);
}

TEST(DualReturn, FullPacketFillsTheBatchExactly) {
  DataPacket packet = dual_packet();
  for (std::size_t block = 0; block < 12; ++block) {
    for (std::size_t laser = 0; laser < 32; ++laser) {
      packet.echo(block, laser, block % 2 == 0 ? 9000 : 4000);
    }
  }
  EXPECT_EQ(decode(packet).return_count, ReturnBatch::kMaxReturns);
}

TEST(DualReturn, OldFirmwareIsRecognisedByItsAzimuths) {
  const ReturnBatch batch =
      decode(dual_packet().mode(0).product(0).echo(0, 15, 9000).echo(1, 15, 4000));
  EXPECT_EQ(batch.firing_count, 6);
  EXPECT_EQ(batch.return_count, 2);
}

}  // namespace
}  // namespace convexcut::velodyne
