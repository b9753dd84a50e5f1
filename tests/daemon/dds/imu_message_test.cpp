// SPDX-License-Identifier: Apache-2.0
//
// Does not prove what a ROS 2 node makes of the bytes: no ROS 2 is needed to build or test this.
#include "daemon/dds/imu_message.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/dds/publisher.hpp"
#include "daemon/dds/qos.hpp"
#include "daemon/dds/ros2_time.hpp"
#include "support/test_domain.hpp"
#include "support/test_reader.hpp"

namespace convexcut::daemon {
namespace {

ImuSample full_sample() {
  ImuSample sample;
  sample.q_level_from_imu = Quaternion(0.1, 0.2, 0.3, 0.4);  // w, x, y, z
  sample.angular_velocity_rad_s = {1.0F, 2.0F, 3.0F};
  sample.acceleration_m_s2 = {4.0F, 5.0F, 6.0F};
  sample.has_orientation = true;
  sample.has_angular_velocity = true;
  sample.has_acceleration = true;
  return sample;
}

TEST(ImuMessage, HasTheQuaternionsScalarLast) {
  std::string frame = "imu";
  const auto message = imu_message(full_sample(), HostTime{}, frame);
  EXPECT_EQ(message.orientation.x, 0.2);
  EXPECT_EQ(message.orientation.y, 0.3);
  EXPECT_EQ(message.orientation.z, 0.4);
  EXPECT_EQ(message.orientation.w, 0.1);
}

TEST(ImuMessage, HoldsRatesAndAcceleration) {
  std::string frame = "imu";
  const auto message = imu_message(full_sample(), HostTime{}, frame);
  EXPECT_EQ(message.angular_velocity.x, 1.0);
  EXPECT_EQ(message.angular_velocity.z, 3.0);
  EXPECT_EQ(message.linear_acceleration.x, 4.0);
  EXPECT_EQ(message.linear_acceleration.z, 6.0);
  EXPECT_EQ(message.orientation_covariance[0], 0.0);
  EXPECT_EQ(message.angular_velocity_covariance[0], 0.0);
  EXPECT_EQ(message.linear_acceleration_covariance[0], 0.0);
}

TEST(ImuMessage, MarksWhatTheSampleDoesNotHold) {
  std::string frame = "imu";
  ImuSample sample = full_sample();
  sample.has_orientation = false;
  EXPECT_EQ(imu_message(sample, HostTime{}, frame).orientation_covariance[0], -1.0);
  sample = full_sample();
  sample.has_angular_velocity = false;
  EXPECT_EQ(imu_message(sample, HostTime{}, frame).angular_velocity_covariance[0], -1.0);
  sample = full_sample();
  sample.has_acceleration = false;
  EXPECT_EQ(imu_message(sample, HostTime{}, frame).linear_acceleration_covariance[0], -1.0);
}

TEST(Ros2Time, SplitsIntoSecondsAndNanoseconds) {
  const auto time = to_ros2_time(from_ns<HostTime>(1'700'000'000'999'999'999));
  EXPECT_EQ(time.sec, 1'700'000'000);
  EXPECT_EQ(time.nanosec, 999'999'999U);
}

TEST(Ros2Time, BeforeTheEpochCountsNanosecondsUpFromAnEarlierSecond) {
  const auto time = to_ros2_time(from_ns<HostTime>(-1));
  EXPECT_EQ(time.sec, -1);
  EXPECT_EQ(time.nanosec, 999'999'999U);
}

// The layout by hand: 4 bytes of encapsulation, then stamp, frame_id, 37 doubles aligned to 8.
std::vector<std::uint8_t> golden_imu() {
  std::vector<std::uint8_t> bytes{0, 1, 0, 0,                     // CDR, little-endian
                                  1, 0, 0, 0, 2,   0,   0,   0,   // 1 s, 2 ns
                                  4, 0, 0, 0, 'i', 'm', 'u', 0};  // with its NUL
  bytes.resize(4 + 16 + 37 * 8, 0);
  const std::array<std::uint8_t, 8> one{0, 0, 0, 0, 0, 0, 0xf0, 0x3f};
  std::copy(one.begin(), one.end(), bytes.begin() + 4 + 40);  // orientation.w
  return bytes;
}

TEST(ImuMessage, IsSerialisedAsRos2Does) {
  const config::Dds settings = testing::test_settings();
  const Participant participant(settings);
  ImuPublisher publisher(participant, settings);
  testing::TestReader reader(participant, kImuType, "rt/imu/data",
                             testing::ros2_default_qos().get());
  ImuSample sample;
  sample.has_orientation = true;
  sample.has_angular_velocity = true;
  sample.has_acceleration = true;
  ASSERT_EQ(publisher.publish(sample, from_ns<HostTime>(1'000'000'002)), PublishStatus::sent);
  const std::vector<std::uint8_t> bytes = reader.take_cdr();
  EXPECT_EQ(bytes.size(), 316U);
  EXPECT_EQ(bytes, golden_imu());
}

}  // namespace
}  // namespace convexcut::daemon
