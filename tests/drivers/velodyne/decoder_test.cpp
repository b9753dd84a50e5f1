// SPDX-License-Identifier: Apache-2.0
//
// Geometry and timing of single-return packets, by hand-built packets with hand-computed results.
// Does not prove: that the manuals describe the sensors rightly.
#include "drivers/velodyne/decoder.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/drivers/velodyne/packets.hpp"

namespace convexcut::velodyne {
namespace {

using test::DataPacket;

constexpr HostTime kArrival = from_ns<HostTime>(1'700'000'000'000'000'000);

ReturnBatch decode(ModelId model, const DataPacket& packet, DecoderOptions options = {}) {
  ReturnBatch batch;
  EXPECT_EQ(DataDecoder(model_of(model), options).decode(packet.bytes(), kArrival, batch),
            DecodeStatus::ok);
  return batch;
}

double elevation_deg(const ReturnBatch& batch, std::size_t i) {
  return std::asin(static_cast<double>(batch.z_lidar[i]) / static_cast<double>(batch.range_m[i])) *
         180.0 / M_PI;
}

// Clockwise from x, as the sensor counts.
double azimuth_deg(const ReturnBatch& batch, std::size_t i) {
  const auto x = static_cast<double>(batch.x_lidar[i]);
  const auto y = static_cast<double>(batch.y_lidar[i]);
  const double counterclockwise = std::atan2(y, x) * 180.0 / M_PI;
  return counterclockwise > 0 ? 360.0 - counterclockwise : -counterclockwise;
}

TEST(DataDecoder, StatesArrivalTimestampAndFiringPeriod) {
  const ReturnBatch batch = decode(ModelId::hdl32e, DataPacket().timestamp(835'374'683));
  EXPECT_EQ(batch.arrival, kArrival);
  EXPECT_EQ(batch.first_firing.count, 835'374'683U);
  EXPECT_EQ(batch.firing_period_ns, 46'080U);
  EXPECT_EQ(batch.span(), Duration{552'960});
}

TEST(DataDecoder, DistanceZeroIsNoReturn) {
  const ReturnBatch batch = decode(ModelId::hdl32e, DataPacket().echo(0, 3, 0, 255));
  EXPECT_EQ(batch.return_count, 0);
  EXPECT_EQ(batch.firing_count, 12);
}

// REP-103: x forward at azimuth 0, y left. Laser 15 is level.
TEST(DataDecoder, AzimuthZeroIsForward) {
  const ReturnBatch batch =
      decode(ModelId::hdl32e, DataPacket().azimuths(0, 0).echo(0, 15, 5000, 77));
  ASSERT_EQ(batch.return_count, 1);
  EXPECT_FLOAT_EQ(batch.x_lidar[0], 10.0F);
  EXPECT_FLOAT_EQ(batch.y_lidar[0], 0.0F);
  EXPECT_FLOAT_EQ(batch.z_lidar[0], 0.0F);
  EXPECT_FLOAT_EQ(batch.range_m[0], 10.0F);
  EXPECT_EQ(batch.intensity[0], 77);
  EXPECT_EQ(batch.ring[0], 23);
  EXPECT_EQ(batch.echo[0], Echo::only);
  EXPECT_TRUE(batch.farthest[0]);
}

TEST(DataDecoder, AzimuthNinetyIsToTheRight) {
  const ReturnBatch batch =
      decode(ModelId::hdl32e, DataPacket().azimuths(9000, 0).echo(0, 15, 5000));
  EXPECT_NEAR(batch.x_lidar[0], 0.0, 1e-9);
  EXPECT_FLOAT_EQ(batch.y_lidar[0], -10.0F);
}

TEST(DataDecoder, AzimuthThirtySixThousandIsTheDirectionOfZero) {
  const ReturnBatch batch =
      decode(ModelId::hdl32e, DataPacket().azimuths(0, 0).azimuth(4, 36000).echo(4, 15, 5000));
  EXPECT_EQ(batch.firings[4].azimuth, Azimuth{});
  EXPECT_FLOAT_EQ(batch.x_lidar[0], 10.0F);
  EXPECT_FLOAT_EQ(batch.y_lidar[0], 0.0F);
}

TEST(DataDecoder, LargestDistanceIs131Metres) {
  const ReturnBatch batch = decode(ModelId::hdl32e, DataPacket().echo(0, 15, 0xFFFF));
  EXPECT_FLOAT_EQ(batch.range_m[0], 131.07F);
}

TEST(Hdl32eDecoder, FirstAndLastLaserPointDownAndUp) {
  const ReturnBatch batch =
      decode(ModelId::hdl32e, DataPacket().azimuths(4500, 0).echo(0, 0, 10000).echo(0, 31, 10000));
  ASSERT_EQ(batch.return_count, 2);
  // 20 m at 45°: r·cos(30.67°)·cos(45°) and so on.
  EXPECT_NEAR(batch.x_lidar[0], 12.163926, 1e-5);
  EXPECT_NEAR(batch.y_lidar[0], -12.163926, 1e-5);
  EXPECT_NEAR(batch.z_lidar[0], -10.201858, 1e-5);
  EXPECT_EQ(batch.ring[0], 0);
  EXPECT_NEAR(elevation_deg(batch, 1), 10.67, 1e-5);
  EXPECT_EQ(batch.ring[1], 31);
}

// The trap: 1.152·(c/2) would give 17.28 µs for laser 31 and 0 for laser 1.
TEST(Hdl32eDecoder, OffsetsAre46080ABlockAnd1152ALaser) {
  const DataPacket packet = DataPacket().echo(0, 0, 1).echo(0, 1, 1).echo(3, 2, 1).echo(11, 31, 1);
  const ReturnBatch batch = decode(ModelId::hdl32e, packet);
  ASSERT_EQ(batch.return_count, 4);
  EXPECT_EQ(batch.offset_ns[0], 0U);
  EXPECT_EQ(batch.offset_ns[1], 1'152U);
  EXPECT_EQ(batch.offset_ns[2], 3U * 46'080 + 2'304);
  EXPECT_EQ(batch.offset_ns[3], 542'592U);
}

TEST(Hdl32eDecoder, LasersTurnOnAFortiethOfTheStepEach) {
  const ReturnBatch batch = decode(
      ModelId::hdl32e,
      DataPacket().azimuths(10000, 16).echo(2, 0, 10000).echo(2, 1, 10000).echo(2, 31, 10000));
  EXPECT_NEAR(azimuth_deg(batch, 0), 100.32, 1e-5);
  EXPECT_NEAR(azimuth_deg(batch, 1), 100.32 + 0.16 / 40, 1e-5);
  EXPECT_NEAR(azimuth_deg(batch, 2), 100.32 + 0.16 * 31 / 40, 1e-5);
}

TEST(Hdl32eDecoder, LastBlockTurnsOnAsTheOneBefore) {
  const ReturnBatch batch =
      decode(ModelId::hdl32e, DataPacket().azimuths(10000, 16).echo(11, 31, 10000));
  EXPECT_NEAR(azimuth_deg(batch, 0), 100.0 + 11 * 0.16 + 0.16 * 31 / 40, 1e-5);
}

TEST(Hdl32eDecoder, LasersCrossTheEndOfTheTurn) {
  const ReturnBatch batch =
      decode(ModelId::hdl32e, DataPacket().azimuths(35990, 20).echo(0, 30, 10000));
  EXPECT_NEAR(azimuth_deg(batch, 0), 359.90 + 0.20 * 30 / 40 - 360.0, 1e-5);
}

TEST(Hdl32eDecoder, AGlitchOfTheEncoderDoesNotSpreadOverTheBlockBefore) {
  const ReturnBatch batch = decode(
      ModelId::hdl32e, DataPacket().azimuths(10000, 16).azimuth(5, 20000).echo(4, 31, 10000));
  EXPECT_NEAR(azimuth_deg(batch, 0), 100.64 + 0.16 * 31 / 40, 1e-5);
}

TEST(Hdl32eDecoder, StoppedRotorWithEqualAzimuthsInSingleModeKeepsTwelveFirings) {
  const ReturnBatch batch =
      decode(ModelId::hdl32e, DataPacket().azimuths(7000, 0).echo(0, 15, 5000).echo(1, 15, 5000));
  EXPECT_EQ(batch.firing_count, 12);
  ASSERT_EQ(batch.return_count, 2);
  EXPECT_EQ(batch.offset_ns[1] - batch.offset_ns[0], 46'080U);
  EXPECT_EQ(batch.echo[1], Echo::only);
}

TEST(Hdl32eDecoder, FiringsHoldTheirReturnsInOrder) {
  DataPacket packet;
  packet.azimuths(10000, 16).echo(0, 4, 100).echo(0, 9, 100).echo(2, 0, 100).echo(11, 31, 100);
  const ReturnBatch batch = decode(ModelId::hdl32e, packet);
  ASSERT_EQ(batch.firing_count, 12);
  EXPECT_EQ(batch.firings[0].first_return, 0);
  EXPECT_EQ(batch.firings[0].return_count, 2);
  EXPECT_EQ(batch.firings[1].return_count, 0);
  EXPECT_EQ(batch.firings[2].first_return, 2);
  EXPECT_EQ(batch.firings[2].return_count, 1);
  EXPECT_EQ(batch.firings[2].azimuth, Azimuth::from_centidegrees(10032));
  EXPECT_EQ(batch.firings[2].offset_ns, 92'160U);
  EXPECT_EQ(batch.firings[11].first_return, 3);
}

TEST(Hdl32eDecoder, VerticalOffsetsRaiseThePointsOnlyWhenAskedFor) {
  const DataPacket packet = DataPacket().azimuths(0, 0).echo(0, 0, 10000);
  const ReturnBatch plain = decode(ModelId::hdl32e, packet);
  const ReturnBatch raised = decode(ModelId::hdl32e, packet, {.vertical_offsets = true});
  EXPECT_NEAR(raised.z_lidar[0] - plain.z_lidar[0], 0.01717, 2e-6);
  EXPECT_EQ(raised.x_lidar[0], plain.x_lidar[0]);
  EXPECT_EQ(raised.range_m[0], plain.range_m[0]);
}

TEST(Vlp16Decoder, ABlockIsTwoFiringsOfSixteen) {
  const DataPacket packet = DataPacket()
                                .azimuths(10000, 48)
                                .product(0x22)
                                .echo(0, 0, 100)
                                .echo(0, 16, 100)
                                .echo(11, 31, 100);
  const ReturnBatch batch = decode(ModelId::vlp16, packet);
  ASSERT_EQ(batch.firing_count, 24);
  EXPECT_EQ(batch.firing_period_ns, 55'296U);
  EXPECT_EQ(batch.span(), Duration{1'327'104});
  EXPECT_EQ(batch.offset_ns[0], 0U);
  EXPECT_EQ(batch.offset_ns[1], 55'296U);
  EXPECT_EQ(batch.firings[1].offset_ns, 55'296U);
  EXPECT_EQ(batch.firings[1].first_return, 1);
  EXPECT_EQ(batch.offset_ns[2], 11U * 110'592 + 55'296 + 15 * 2'304);
  EXPECT_NEAR(elevation_deg(batch, 1), -15.0, 1e-4);
  EXPECT_NEAR(elevation_deg(batch, 2), 15.0, 1e-4);
  EXPECT_EQ(batch.ring[2], 15);
}

TEST(Vlp16Decoder, SecondFiringsAzimuthIsInterpolated) {
  const DataPacket packet = DataPacket()
                                .azimuths(10000, 48)
                                .product(0x22)
                                .echo(0, 15, 10000)
                                .echo(0, 16, 10000)
                                .echo(0, 31, 10000);
  const ReturnBatch batch = decode(ModelId::vlp16, packet);
  EXPECT_EQ(batch.firings[0].azimuth, Azimuth::from_centidegrees(10000));
  EXPECT_EQ(batch.firings[1].azimuth, Azimuth::from_centidegrees(10024));
  EXPECT_NEAR(azimuth_deg(batch, 0), 100.15, 1e-5);
  EXPECT_NEAR(azimuth_deg(batch, 1), 100.24, 1e-5);
  EXPECT_NEAR(azimuth_deg(batch, 2), 100.39, 1e-5);
}

TEST(PuckHiresDecoder, HasItsOwnElevationsAndTheVlp16sTiming) {
  const DataPacket packet = DataPacket().product(0x24).echo(0, 0, 10000).echo(0, 31, 10000);
  const ReturnBatch batch = decode(ModelId::puck_hires, packet);
  EXPECT_NEAR(elevation_deg(batch, 0), -10.0, 1e-4);
  EXPECT_NEAR(elevation_deg(batch, 1), 10.0, 1e-4);
  EXPECT_EQ(batch.offset_ns[1], 55'296U + 15 * 2'304);
}

TEST(Vlp32cDecoder, AzimuthOffsetsAreAdded) {
  const DataPacket packet =
      DataPacket().azimuths(10000, 0).product(0x28).echo(0, 0, 5000).echo(0, 1, 5000);
  const ReturnBatch batch = decode(ModelId::vlp32c, packet);
  EXPECT_NEAR(azimuth_deg(batch, 0), 101.4, 1e-5);
  EXPECT_NEAR(azimuth_deg(batch, 1), 95.8, 1e-5);
  EXPECT_EQ(batch.firings[0].azimuth, Azimuth::from_centidegrees(10000));
}

TEST(Vlp32cDecoder, AzimuthOffsetsCrossTheEndOfTheTurn) {
  const DataPacket packet =
      DataPacket().azimuths(0, 0).product(0x28).echo(0, 1, 5000).echo(1, 28, 5000);
  const ReturnBatch batch = decode(ModelId::vlp32c, packet);
  EXPECT_NEAR(azimuth_deg(batch, 0), 355.8, 1e-5);
  EXPECT_NEAR(azimuth_deg(batch, 1), 4.2, 1e-5);
}

TEST(Vlp32cDecoder, UnitIsFourMillimetresAndLasersFireInPairs) {
  const DataPacket packet = DataPacket()
                                .product(0x28)
                                .echo(0, 0, 5000)
                                .echo(0, 1, 5000)
                                .echo(0, 2, 5000)
                                .echo(11, 31, 5000);
  const ReturnBatch batch = decode(ModelId::vlp32c, packet);
  EXPECT_FLOAT_EQ(batch.range_m[0], 20.0F);
  EXPECT_EQ(batch.offset_ns[1], 0U);
  EXPECT_EQ(batch.offset_ns[2], 2'304U);
  EXPECT_EQ(batch.offset_ns[3], 11U * 55'296 + 15 * 2'304);
  EXPECT_NEAR(elevation_deg(batch, 0), -25.0, 1e-4);
  EXPECT_NEAR(elevation_deg(batch, 3), -1.333, 1e-4);
}

}  // namespace
}  // namespace convexcut::velodyne
