// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that PCL or RViz like the layout; what they read of it is in docs/design/dds.md.
#include "daemon/dds/cloud_message.hpp"

#include <cstring>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "drivers/wire.hpp"
#include "support/test_reader.hpp"

namespace convexcut::daemon {
namespace {

using testing::made_up_scan;

std::span<const std::byte> point_bytes(const sensor_msgs_msg_dds__PointCloud2_& message,
                                       std::size_t i) {
  return std::as_bytes(std::span(message.data._buffer, message.data._length))
      .subspan(i * message.point_step, message.point_step);
}

float load_float(std::span<const std::byte> bytes, std::size_t offset) {
  float value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST(CloudMessage, HasTheDocumentedFields) {
  CloudMessage cloud("level", CloudContent::all_points, 0);
  const auto& message = cloud.fill(made_up_scan(1));
  struct Expected {
    const char* name;
    std::uint32_t offset;
    std::uint8_t datatype;
  };
  const std::vector<Expected> expected{{"x", 0, 7},          {"y", 4, 7},  {"z", 8, 7},
                                       {"intensity", 12, 7}, {"t", 16, 6}, {"ring", 20, 4},
                                       {"label", 22, 2}};
  ASSERT_EQ(message.fields._length, expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& field = message.fields._buffer[i];
    EXPECT_STREQ(field.name, expected[i].name);
    EXPECT_EQ(field.offset, expected[i].offset) << field.name;
    EXPECT_EQ(field.datatype, expected[i].datatype) << field.name;
    EXPECT_EQ(field.count, 1U) << field.name;
  }
  EXPECT_EQ(message.point_step, 24U);
}

TEST(CloudMessage, HoldsAllPointsWithTheirLabelsInOrder) {
  const LevelledScan scan = made_up_scan(100);
  CloudMessage cloud("level", CloudContent::all_points, 0);
  const auto& message = cloud.fill(scan);
  ASSERT_EQ(message.width, 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    const auto bytes = point_bytes(message, i);
    EXPECT_EQ(load_float(bytes, 0), scan.x[i]);
    EXPECT_EQ(load_float(bytes, 4), scan.y[i]);
    EXPECT_EQ(load_float(bytes, 8), scan.z[i]);
    EXPECT_EQ(load_float(bytes, 12), static_cast<float>(scan.intensity[i]));
    EXPECT_EQ(wire::load_le<std::uint32_t>(bytes, 16), scan.time_ns[i]);
    EXPECT_EQ(wire::load_le<std::uint16_t>(bytes, 20), scan.ring[i]);
    EXPECT_EQ(wire::load_u8(bytes, 22), i % 3 == 0 ? 1 : 0);
    EXPECT_EQ(wire::load_u8(bytes, 23), 0);
  }
}

TEST(CloudMessage, OfTheStructureHoldsItsPointsOnly) {
  const LevelledScan scan = made_up_scan(100);
  CloudMessage cloud("level", CloudContent::structure_only, 0);
  const auto& message = cloud.fill(scan);
  ASSERT_EQ(message.width, scan.structure_points);
  for (std::size_t i = 0; i < message.width; ++i) {
    EXPECT_EQ(load_float(point_bytes(message, i), 0), scan.x[3 * i]);
    EXPECT_EQ(wire::load_u8(point_bytes(message, i), 22), 1);
  }
}

TEST(CloudMessage, DescribesItsData) {
  CloudMessage cloud("level", CloudContent::all_points, 0);
  const auto& message = cloud.fill(made_up_scan(10));
  EXPECT_STREQ(message.header.frame_id, "level");
  EXPECT_EQ(message.header.stamp.sec, 1'700'000'000);
  EXPECT_EQ(message.header.stamp.nanosec, 123'456'789U);
  EXPECT_EQ(message.height, 1U);
  EXPECT_EQ(message.row_step, 240U);
  EXPECT_EQ(message.data._length, 240U);
  EXPECT_FALSE(message.is_bigendian);
  EXPECT_TRUE(message.is_dense);
}

TEST(CloudMessage, OfAScanWithoutPointsIsAValidMessageWithoutPoints) {
  CloudMessage cloud("level", CloudContent::all_points, 0);
  static_cast<void>(cloud.fill(made_up_scan(50)));  // leftovers must not show
  const auto& message = cloud.fill(made_up_scan(0));
  EXPECT_EQ(message.height, 1U);
  EXPECT_EQ(message.width, 0U);
  EXPECT_EQ(message.row_step, 0U);
  EXPECT_EQ(message.data._length, 0U);
  EXPECT_EQ(message.fields._length, 7U);
}

TEST(CloudMessage, ReusesItsMemoryUpToTheExpectedSize) {
  CloudMessage cloud("level", CloudContent::all_points, 100);
  const std::uint8_t* const first = cloud.fill(made_up_scan(1)).data._buffer;
  EXPECT_EQ(cloud.fill(made_up_scan(100)).data._buffer, first);
}

TEST(CloudMessage, GrowsForALargerScan) {
  CloudMessage cloud("level", CloudContent::all_points, 1);
  EXPECT_EQ(cloud.fill(made_up_scan(1000)).width, 1000U);
}

TEST(CloudMessage, KeepsItsMemoryFromCyclone) {
  CloudMessage cloud("level", CloudContent::all_points, 1);
  const auto& message = cloud.fill(made_up_scan(1));
  EXPECT_FALSE(message.data._release);
  EXPECT_FALSE(message.fields._release);
}

}  // namespace
}  // namespace convexcut::daemon
