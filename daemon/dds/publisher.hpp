// SPDX-License-Identifier: Apache-2.0
//
// Our topics. Everything here is for the publisher thread, which is not a realtime one: DDS
// allocates and locks, and a write may block for dds.max_blocking_ms. The topics' counts
// and readers may be asked for by any thread.
#pragma once

#include <string>

#include "config/config.hpp"
#include "core/imu_sample.hpp"
#include "core/scan/scan.hpp"
#include "daemon/dds/cloud_message.hpp"
#include "daemon/dds/participant.hpp"
#include "daemon/dds/scan_status.hpp"
#include "daemon/dds/topic_writer.hpp"

namespace convexcut::daemon {

// Scans as two sensor_msgs/PointCloud2 topics in dds.level_frame: what is structure
// (dds.structure_topic), and all points with their labels (dds.points_topic).
class ScanPublisher {
 public:
  // DdsError when a topic cannot be made.
  ScanPublisher(const Participant& participant, const config::Dds& settings);

  // The structure goes first: it is what has a deadline, and the smaller of the two. Preparing it
  // does all that need not wait for its instant.
  void prepare_structure(const LevelledScan& scan);
  PublishStatus publish_prepared_structure();
  PublishStatus publish_structure(const LevelledScan& scan);
  PublishStatus publish_points(const LevelledScan& scan);

  [[nodiscard]] const TopicWriter& structure() const noexcept { return structure_; }
  [[nodiscard]] const TopicWriter& points() const noexcept { return points_; }

 private:
  TopicWriter structure_;
  TopicWriter points_;
  CloudMessage structure_message_;
  CloudMessage points_message_;
  const void* prepared_structure_ = nullptr;  // null: nobody listened
};

// IMU samples as sensor_msgs/Imu in dds.imu_frame. What a sample does not hold has −1 as the first
// element of its covariance (Imu.msg's convention); other covariances are 0, "unknown".
class ImuPublisher {
 public:
  ImuPublisher(const Participant& participant, const config::Dds& settings);

  // stamp: the sample's time in host time.
  PublishStatus publish(const ImuSample& sample, HostTime stamp);

  [[nodiscard]] const TopicWriter& imu() const noexcept { return imu_; }

 private:
  TopicWriter imu_;
  std::string frame_id_;
};

// convexcut/msg/ScanStatus on convexcut/status, for `convexcut watch` and other monitors.
class StatusPublisher {
 public:
  StatusPublisher(const Participant& participant, const config::Dds& settings);

  PublishStatus publish(const ScanStatus& status);

  [[nodiscard]] const TopicWriter& status() const noexcept { return status_; }

 private:
  TopicWriter status_;
};

}  // namespace convexcut::daemon
