// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/imu_message.hpp"

#include "daemon/dds/ros2_time.hpp"

namespace convexcut::daemon {
namespace {

constexpr double kNotProvided = -1.0;  // Imu.msg, of the first element of a covariance

geometry_msgs_msg_dds__Vector3_ to_vector3(const Vec3f& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

}  // namespace

sensor_msgs_msg_dds__Imu_ imu_message(const ImuSample& sample, HostTime stamp,
                                      std::string& frame_id) {
  sensor_msgs_msg_dds__Imu_ message{};
  message.header.stamp = to_ros2_time(stamp);
  message.header.frame_id = frame_id.data();
  const Quaternion& q = sample.q_level_from_imu;
  message.orientation = {q.x(), q.y(), q.z(), q.w()};
  message.angular_velocity = to_vector3(sample.angular_velocity_rad_s);
  message.linear_acceleration = to_vector3(sample.acceleration_m_s2);
  if (!sample.has_orientation) message.orientation_covariance[0] = kNotProvided;
  if (!sample.has_angular_velocity) message.angular_velocity_covariance[0] = kNotProvided;
  if (!sample.has_acceleration) message.linear_acceleration_covariance[0] = kNotProvided;
  return message;
}

}  // namespace convexcut::daemon
