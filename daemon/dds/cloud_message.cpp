// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/cloud_message.hpp"

#include <bit>
#include <utility>

#include "daemon/dds/ros2_time.hpp"

namespace convexcut::daemon {
namespace {

WirePoint wire_point(const LevelledScan& scan, std::size_t i) {
  return {scan.x[i],
          scan.y[i],
          scan.z[i],
          static_cast<float>(scan.intensity[i]),
          scan.time_ns[i],
          scan.ring[i],
          static_cast<std::uint8_t>(scan.label[i]),
          0};
}

}  // namespace

CloudMessage::CloudMessage(std::string frame_id, CloudContent content, std::size_t expected_points)
    : frame_id_(std::move(frame_id)), content_(content) {
  points_.reserve(expected_points);
  for (std::size_t i = 0; i < kPointFields.size(); ++i) {
    field_names_[i] = kPointFields[i].name;
    fields_[i].name = field_names_[i].data();
    fields_[i].offset = kPointFields[i].offset;
    fields_[i].datatype = static_cast<std::uint8_t>(kPointFields[i].datatype);
    fields_[i].count = 1;
  }
  message_.header.frame_id = frame_id_.data();
  message_.height = 1;
  // _release false: the sequences stay ours, Cyclone DDS only reads them.
  message_.fields = {static_cast<std::uint32_t>(fields_.size()),
                     static_cast<std::uint32_t>(fields_.size()), fields_.data(), false};
  message_.is_bigendian = std::endian::native == std::endian::big;
  message_.point_step = kPointStep;
  message_.is_dense = true;
}

const sensor_msgs_msg_dds__PointCloud2_& CloudMessage::fill(const LevelledScan& scan) {
  points_.clear();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (content_ == CloudContent::all_points || scan.label[i] == Label::structure) {
      points_.push_back(wire_point(scan, i));
    }
  }
  message_.header.stamp = to_ros2_time(scan.stamp);
  message_.width = static_cast<std::uint32_t>(points_.size());
  message_.row_step = message_.width * kPointStep;
  message_.data = {message_.row_step, message_.row_step,
                   reinterpret_cast<std::uint8_t*>(points_.data()), false};
  return message_;
}

}  // namespace convexcut::daemon
