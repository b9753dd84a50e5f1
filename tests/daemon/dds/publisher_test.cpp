// SPDX-License-Identifier: Apache-2.0
//
// Samples through DDS within one process. Does not prove anything about the network or about time.
#include "daemon/dds/publisher.hpp"

#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "daemon/dds/qos.hpp"
#include "support/test_domain.hpp"
#include "support/test_reader.hpp"

namespace convexcut::daemon {
namespace {

using testing::made_up_scan;
using testing::ros2_default_qos;
using testing::test_settings;
using testing::TestReader;
using PointCloud2 = sensor_msgs_msg_dds__PointCloud2_;

class PublisherTest : public ::testing::Test {
 protected:
  config::Dds settings_ = test_settings();
  Participant participant_{settings_};
};

bool same_cloud(const PointCloud2& a, const PointCloud2& b) {
  return a.width == b.width && a.height == b.height && a.point_step == b.point_step &&
         a.row_step == b.row_step && a.is_dense == b.is_dense && a.is_bigendian == b.is_bigendian &&
         a.fields._length == b.fields._length && a.header.stamp.sec == b.header.stamp.sec &&
         a.header.stamp.nanosec == b.header.stamp.nanosec &&
         std::strcmp(a.header.frame_id, b.header.frame_id) == 0 &&
         std::equal(a.data._buffer, a.data._buffer + a.data._length, b.data._buffer,
                    b.data._buffer + b.data._length);
}

TEST_F(PublisherTest, ReadersGetTheScanAsItWasFilled) {
  ScanPublisher publisher(participant_, settings_);
  TestReader structure(participant_, kPointCloud2Type, "rt/convexcut/structure",
                       ros2_default_qos().get());
  TestReader points(participant_, kPointCloud2Type, "rt/convexcut/points",
                    reader_qos(5, kPointCloud2Type).get());
  const LevelledScan scan = made_up_scan(1000);
  ASSERT_EQ(publisher.publish_structure(scan), PublishStatus::sent);
  ASSERT_EQ(publisher.publish_points(scan), PublishStatus::sent);

  CloudMessage structure_cloud("level", CloudContent::structure_only, 0);
  CloudMessage points_cloud("level", CloudContent::all_points, 0);
  EXPECT_TRUE(structure.take<PointCloud2>(
      [&](const PointCloud2& got) { EXPECT_TRUE(same_cloud(got, structure_cloud.fill(scan))); }));
  EXPECT_TRUE(points.take<PointCloud2>(
      [&](const PointCloud2& got) { EXPECT_TRUE(same_cloud(got, points_cloud.fill(scan))); }));
}

TEST_F(PublisherTest, AScanWithoutPointsArrivesAsAnEmptyCloud) {
  ScanPublisher publisher(participant_, settings_);
  TestReader reader(participant_, kPointCloud2Type, "rt/convexcut/structure",
                    ros2_default_qos().get());
  ASSERT_EQ(publisher.publish_structure(LevelledScan{}), PublishStatus::sent);
  EXPECT_TRUE(reader.take<PointCloud2>([](const PointCloud2& got) {
    EXPECT_EQ(got.height, 1U);
    EXPECT_EQ(got.width, 0U);
    EXPECT_EQ(got.data._length, 0U);
    EXPECT_EQ(got.fields._length, 7U);
  }));
}

TEST_F(PublisherTest, WithoutReadersNothingIsWritten) {
  ScanPublisher publisher(participant_, settings_);
  EXPECT_EQ(publisher.publish_structure(made_up_scan(10)), PublishStatus::no_reader);
  EXPECT_EQ(publisher.structure().sent(), 0U);
}

TEST_F(PublisherTest, ReadersThatComeLaterGetTheNextScan) {
  ScanPublisher publisher(participant_, settings_);
  EXPECT_EQ(publisher.publish_structure(made_up_scan(10)), PublishStatus::no_reader);
  TestReader reader(participant_, kPointCloud2Type, "rt/convexcut/structure",
                    ros2_default_qos().get());
  EXPECT_EQ(publisher.publish_structure(made_up_scan(20)), PublishStatus::sent);
  EXPECT_TRUE(reader.take<PointCloud2>([](const PointCloud2& got) { EXPECT_EQ(got.width, 7U); }));
  EXPECT_FALSE(reader.take<PointCloud2>([](const PointCloud2&) {}));
}

TEST_F(PublisherTest, AReaderThatTakesNothingMakesTheWriteTimeOutAndBeCounted) {
  settings_.max_blocking_ms = 5;
  ScanPublisher publisher(participant_, settings_);
  const Qos qos = ros2_default_qos();
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_resource_limits(qos.get(), 1, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  TestReader full(participant_, kPointCloud2Type, "rt/convexcut/structure", qos.get());
  const LevelledScan scan = made_up_scan(10);
  EXPECT_EQ(publisher.publish_structure(scan), PublishStatus::sent);
  EXPECT_EQ(publisher.publish_structure(scan), PublishStatus::timed_out);
  EXPECT_EQ(publisher.structure().sent(), 1U);
  EXPECT_EQ(publisher.structure().timed_out(), 1U);
  EXPECT_EQ(publisher.structure().failed(), 0U);

  EXPECT_TRUE(full.take<PointCloud2>([](const PointCloud2&) {}));
  EXPECT_EQ(publisher.publish_structure(scan), PublishStatus::sent);
}

TEST_F(PublisherTest, ImuSamplesArriveInTheConfiguredFrame) {
  settings_.imu_frame = "imu_link";
  ImuPublisher publisher(participant_, settings_);
  TestReader reader(participant_, kImuType, "rt/imu/data", ros2_default_qos().get());
  ImuSample sample;
  sample.has_acceleration = true;
  sample.acceleration_m_s2 = {0.0F, 0.0F, 9.5F};
  ASSERT_EQ(publisher.publish(sample, from_ns<HostTime>(5'000'000'007)), PublishStatus::sent);
  EXPECT_TRUE(reader.take<sensor_msgs_msg_dds__Imu_>([](const sensor_msgs_msg_dds__Imu_& got) {
    EXPECT_STREQ(got.header.frame_id, "imu_link");
    EXPECT_EQ(got.header.stamp.sec, 5);
    EXPECT_EQ(got.header.stamp.nanosec, 7U);
    EXPECT_EQ(got.linear_acceleration.z, 9.5);
    EXPECT_EQ(got.orientation_covariance[0], -1.0);
  }));
}

TEST_F(PublisherTest, EveryFieldOfTheStatusArrives) {
  StatusPublisher publisher(participant_, settings_);
  TestReader reader(participant_, kScanStatusType, "rt/convexcut/status", ros2_default_qos().get());
  const ScanStatus sent{from_ns<HostTime>(1'000'000'002),
                        3,
                        ScanEnd::timeout,
                        true,
                        4,
                        5,
                        6,
                        7,
                        0.75,
                        Duration{8},
                        9,
                        10,
                        11,
                        12,
                        13,
                        14};
  ASSERT_EQ(publisher.publish(sent), PublishStatus::sent);
  using Message = convexcut_msg_dds__ScanStatus_;
  EXPECT_TRUE(reader.take<Message>([](const Message& got) {
    EXPECT_EQ(got.stamp.sec, 1);
    EXPECT_EQ(got.stamp.nanosec, 2U);
    EXPECT_EQ(got.index, 3U);
    EXPECT_EQ(got.end, static_cast<std::uint8_t>(ScanEnd::timeout));
    EXPECT_TRUE(got.late);
    EXPECT_EQ(got.points, 4U);
    EXPECT_EQ(got.structure_points, 5U);
    EXPECT_EQ(got.dropped_no_orientation, 6U);
    EXPECT_EQ(got.overflow_returns, 7U);
    EXPECT_EQ(got.coverage, 0.75);
    EXPECT_EQ(got.latency_ns, 8);
    EXPECT_EQ(got.late_scans_total, 9U);
    EXPECT_EQ(got.lost_packets_total, 10U);
    EXPECT_EQ(got.rejected_packets_total, 11U);
    EXPECT_EQ(got.lost_imu_samples_total, 12U);
    EXPECT_EQ(got.ring_overruns_total, 13U);
    EXPECT_EQ(got.publish_timeouts_total, 14U);
  }));
}

TEST_F(PublisherTest, ATopicNameThatRos2CannotNameStopsTheStart) {
  settings_.points_topic = "convexcut/my-points";
  EXPECT_THROW(ScanPublisher(participant_, settings_), DdsError);
}

}  // namespace
}  // namespace convexcut::daemon
