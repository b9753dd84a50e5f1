// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scan/scan.hpp"
#include "daemon/dds/point_layout.hpp"
#include "daemon/dds/ros2.h"

namespace convexcut::daemon {

enum class CloudContent : std::uint8_t { all_points, structure_only };

// A sensor_msgs/PointCloud2 whose memory is ours and reused: filling it allocates only when a scan
// is larger than any before it. Unorganised (height 1), dense, points in firing order. One thread.
class CloudMessage {
 public:
  // Room for expected_points is taken at once.
  CloudMessage(std::string frame_id, CloudContent content, std::size_t expected_points);
  CloudMessage(const CloudMessage&) = delete;  // the message points into this object
  CloudMessage& operator=(const CloudMessage&) = delete;

  // Valid until the next call. A scan without points gives a message without points.
  const sensor_msgs_msg_dds__PointCloud2_& fill(const LevelledScan& scan);

 private:
  std::string frame_id_;
  CloudContent content_;
  std::array<std::string, kPointFields.size()> field_names_;
  std::array<sensor_msgs_msg_dds__PointField_, kPointFields.size()> fields_{};
  std::vector<WirePoint> points_;
  sensor_msgs_msg_dds__PointCloud2_ message_{};
};

}  // namespace convexcut::daemon
