// SPDX-License-Identifier: Apache-2.0
//
// Two real recordings through the whole driver. Does not prove: that a point is where the wall was
// (there is no ground truth); recordings of dual returns, VLP-32C and Puck Hi-Res are not to be
// had.
#include "tests/support/recordings.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/velodyne/lidar_driver.hpp"
#include "tests/drivers/velodyne/capture.hpp"
#include "tests/drivers/velodyne/collecting_sink.hpp"

namespace convexcut::velodyne {
namespace {

using test::CapturedDatagram;
using test::CollectingSink;

constexpr const char* kCourtyard = "lidar/hdl32e_courtyard_2011.pcap";
constexpr const char* kVlp16Gps = "lidar/vlp16_gps_2016.pcap";

void feed(LidarDriver& driver, const std::vector<CapturedDatagram>& datagrams) {
  for (const CapturedDatagram& datagram : datagrams) {
    driver.on_datagram(datagram.payload, datagram.destination_port, datagram.stamp);
  }
  driver.flush();
}

// Straight from the bytes.
std::size_t nonzero_distances(const std::vector<CapturedDatagram>& datagrams) {
  std::size_t count = 0;
  for (const CapturedDatagram& datagram : datagrams) {
    if (datagram.destination_port != 2368) continue;
    for (std::size_t at = 0; at < 1200; at += 100) {
      for (std::size_t c = 0; c < 32; ++c) {
        const std::byte* distance = datagram.payload.data() + at + 4 + 3 * c;
        if (distance[0] != std::byte{0} || distance[1] != std::byte{0}) ++count;
      }
    }
  }
  return count;
}

TEST(CourtyardRecording, EveryPacketOfSourcePort443IsDecodedAsAnHdl32e) {
  CONVEXCUT_NEEDS_RECORDING(file, kCourtyard);
  const std::vector<CapturedDatagram> datagrams = test::read_capture(file);
  ASSERT_EQ(datagrams.front().source_port, 443);
  CollectingSink sink;
  LidarDriver driver({}, sink);
  feed(driver, datagrams);
  EXPECT_EQ(driver.model(), ModelId::hdl32e);
  EXPECT_EQ(sink.batches.size(), 500U);
  EXPECT_EQ(driver.counters().data_packets.value(), 500U);
  EXPECT_EQ(driver.counters().product_differs.value(), 0U);
  EXPECT_TRUE(std::ranges::all_of(
      sink.batches, [](const ReturnBatch& batch) { return batch.firing_count == 12; }));
}

TEST(CourtyardRecording, EveryNonzeroDistanceOfIts192000IsAReturn) {
  CONVEXCUT_NEEDS_RECORDING(file, kCourtyard);
  const std::vector<CapturedDatagram> datagrams = test::read_capture(file);
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  feed(driver, datagrams);
  std::size_t returns = 0;
  for (const ReturnBatch& batch : sink.batches) returns += batch.return_count;
  EXPECT_EQ(returns, nonzero_distances(datagrams));
  EXPECT_EQ(returns, 146'705U);
  EXPECT_EQ(driver.counters().returns.value(), returns);
}

TEST(CourtyardRecording, PointsAreAtTheirRangeAndWithinTheFieldOfView) {
  CONVEXCUT_NEEDS_RECORDING(file, kCourtyard);
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  feed(driver, test::read_capture(file));
  for (const ReturnBatch& batch : sink.batches) {
    for (std::size_t i = 0; i < batch.return_count; ++i) {
      const auto x = static_cast<double>(batch.x_lidar[i]);
      const auto y = static_cast<double>(batch.y_lidar[i]);
      const auto z = static_cast<double>(batch.z_lidar[i]);
      const auto range = static_cast<double>(batch.range_m[i]);
      ASSERT_NEAR(std::sqrt(x * x + y * y + z * z), range, 1e-5);
      ASSERT_GE(z / range, std::sin(-30.68 * M_PI / 180));
      ASSERT_LE(z / range, std::sin(10.68 * M_PI / 180));
    }
  }
}

TEST(CourtyardRecording, FiringAzimuthsTurnSteadilyAcrossPackets) {
  CONVEXCUT_NEEDS_RECORDING(file, kCourtyard);
  CollectingSink sink;
  LidarDriver driver({.model = ModelId::hdl32e}, sink);
  feed(driver, test::read_capture(file));
  const Firing* previous = nullptr;
  for (const ReturnBatch& batch : sink.batches) {
    for (const Firing& firing : std::span(batch.firings).first(batch.firing_count)) {
      if (previous != nullptr) {
        const std::int32_t step = firing.azimuth.clockwise_from(previous->azimuth);
        ASSERT_GE(step, 130'000);
        ASSERT_LE(step, 170'000);
      }
      previous = &firing;
    }
  }
}

TEST(CourtyardRecording, WithoutPositionPacketsThePpsStateIsUnknown) {
  CONVEXCUT_NEEDS_RECORDING(file, kCourtyard);
  CollectingSink sink;
  LidarDriver driver({}, sink);
  feed(driver, test::read_capture(file));
  EXPECT_TRUE(std::ranges::all_of(
      sink.batches, [](const ReturnBatch& batch) { return batch.pps == PpsState::unknown; }));
  EXPECT_FALSE(driver.position().has_value());
}

TEST(Vlp16GpsRecording, EveryPacketIsDecodedAsAVlp16) {
  CONVEXCUT_NEEDS_RECORDING(file, kVlp16Gps);
  const std::vector<CapturedDatagram> datagrams = test::read_capture(file);
  CollectingSink sink;
  LidarDriver driver({}, sink);
  feed(driver, datagrams);
  EXPECT_EQ(driver.model(), ModelId::vlp16);
  EXPECT_EQ(driver.counters().data_packets.value(), 293U);
  EXPECT_EQ(driver.counters().position_packets.value(), 57U);
  EXPECT_EQ(driver.counters().bad_nmea.value(), 0U);
  EXPECT_EQ(driver.counters().returns.value(), nonzero_distances(datagrams));
  EXPECT_EQ(sink.batches.back().firing_count, 24U);
}

TEST(Vlp16GpsRecording, ClockIsLockedAndTheSentenceGivesDateTimeAndPlace) {
  CONVEXCUT_NEEDS_RECORDING(file, kVlp16Gps);
  CollectingSink sink;
  LidarDriver driver({}, sink);
  feed(driver, test::read_capture(file));
  ASSERT_TRUE(driver.position().has_value());
  const PositionPacket& position = *driver.position();
  EXPECT_EQ(position.pps, PpsState::locked);
  EXPECT_EQ(sink.batches.back().pps, PpsState::locked);
  ASSERT_EQ(position.nmea_status, NmeaStatus::ok);
  EXPECT_TRUE(position.fix.valid);
  using namespace std::chrono;
  EXPECT_EQ(position.fix.date, year{2016} / January / 21);
  EXPECT_EQ(position.fix.time_of_day, hours{8} + minutes{18} + seconds{2});
  EXPECT_NEAR(position.fix.latitude->value, 36.829130, 1e-6);
  EXPECT_NEAR(position.fix.longitude->value, -2.4075715, 1e-6);
  EXPECT_TRUE(std::ranges::none_of(position.motion, [](const auto& m) { return m.has_value(); }));
}

// The sensor's minutes and seconds, locked to GPS, against the sentence's.
TEST(Vlp16GpsRecording, SensorTimeIsTheSentencesTimePastTheHour) {
  CONVEXCUT_NEEDS_RECORDING(file, kVlp16Gps);
  CollectingSink sink;
  LidarDriver driver({}, sink);
  feed(driver, test::read_capture(file));
  const Duration past_hour = *driver.position()->fix.time_of_day % std::chrono::hours{1};
  const Duration sensor = std::chrono::microseconds{driver.position()->time.count};
  EXPECT_GE(sensor, past_hour);
  EXPECT_LT(sensor - past_hour, std::chrono::seconds{2});
}

}  // namespace
}  // namespace convexcut::velodyne
