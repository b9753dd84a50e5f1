// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/publisher.hpp"

#include "daemon/dds/imu_message.hpp"
#include "daemon/dds/qos.hpp"
#include "daemon/dds/ros2_time.hpp"
#include "daemon/dds/topic_name.hpp"

namespace convexcut::daemon {
namespace {

// A single-return revolution of an HDL-32E at 10 Hz, and some. Larger scans make the buffer grow.
constexpr std::size_t kExpectedPoints = 72'000;

PublishStatus publish_cloud(TopicWriter& writer, CloudMessage& message, const LevelledScan& scan) {
  if (!writer.has_reader()) return PublishStatus::no_reader;
  return writer.write(&message.fill(scan));
}

}  // namespace

ScanPublisher::ScanPublisher(const Participant& participant, const config::Dds& settings)
    : structure_(participant, kPointCloud2Type, settings.structure_topic,
                 cloud_writer_qos(settings, kPointCloud2Type)),
      points_(participant, kPointCloud2Type, settings.points_topic,
              cloud_writer_qos(settings, kPointCloud2Type)),
      structure_message_(settings.level_frame, CloudContent::structure_only, kExpectedPoints),
      points_message_(settings.level_frame, CloudContent::all_points, kExpectedPoints) {}

void ScanPublisher::prepare_structure(const LevelledScan& scan) {
  prepared_structure_ = structure_.has_reader() ? &structure_message_.fill(scan) : nullptr;
}

PublishStatus ScanPublisher::publish_prepared_structure() {
  if (prepared_structure_ == nullptr) return PublishStatus::no_reader;
  return structure_.write(prepared_structure_);
}

PublishStatus ScanPublisher::publish_structure(const LevelledScan& scan) {
  prepare_structure(scan);
  return publish_prepared_structure();
}

PublishStatus ScanPublisher::publish_points(const LevelledScan& scan) {
  return publish_cloud(points_, points_message_, scan);
}

ImuPublisher::ImuPublisher(const Participant& participant, const config::Dds& settings)
    : imu_(participant, kImuType, settings.imu_topic, message_writer_qos(settings, kImuType)),
      frame_id_(settings.imu_frame) {}

PublishStatus ImuPublisher::publish(const ImuSample& sample, HostTime stamp) {
  if (!imu_.has_reader()) return PublishStatus::no_reader;
  const sensor_msgs_msg_dds__Imu_ message = imu_message(sample, stamp, frame_id_);
  return imu_.write(&message);
}

StatusPublisher::StatusPublisher(const Participant& participant, const config::Dds& settings)
    : status_(participant, kScanStatusType, kStatusTopic,
              message_writer_qos(settings, kScanStatusType)) {}

PublishStatus StatusPublisher::publish(const ScanStatus& status) {
  if (!status_.has_reader()) return PublishStatus::no_reader;
  convexcut_msg_dds__ScanStatus_ message{};
  message.stamp = to_ros2_time(status.stamp);
  message.index = status.index;
  message.end = static_cast<std::uint8_t>(status.end);
  message.late = status.late;
  message.points = status.points;
  message.structure_points = status.structure_points;
  message.dropped_no_orientation = status.dropped_no_orientation;
  message.overflow_returns = status.overflow_returns;
  message.coverage = status.coverage;
  message.latency_ns = status.latency.count();
  message.late_scans_total = status.late_scans_total;
  message.lost_packets_total = status.lost_packets_total;
  message.rejected_packets_total = status.rejected_packets_total;
  message.lost_imu_samples_total = status.lost_imu_samples_total;
  message.ring_overruns_total = status.ring_overruns_total;
  message.publish_timeouts_total = status.publish_timeouts_total;
  message.effort = status.effort;
  message.reduced_scans_total = status.reduced_scans_total;
  return status_.write(&message);
}

}  // namespace convexcut::daemon
