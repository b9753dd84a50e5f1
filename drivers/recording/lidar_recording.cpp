// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/lidar_recording.hpp"

namespace convexcut::recording {

LidarRecording::LidarRecording(const std::filesystem::path& file,
                               const velodyne::LidarDriverOptions& options, Sink<ReturnBatch>& sink)
    : reader_(file), driver_(options, sink) {
  if (reader_.link() == capture::LinkKind::serial || reader_.link() == capture::LinkKind::can) {
    throw capture::CaptureError(
        file.string() +
        ": expected a network capture with lidar packets, found a recording "
        "of a serial line or a CAN bus (did you mean --imu or --can?)");
  }
}

std::optional<HostTime> LidarRecording::next_stamp() {
  while (!have_record_) {
    if (reader_.next(record_) != capture::ReadStatus::record) return std::nullopt;
    have_record_ = record_.kind == capture::RecordKind::datagram;
  }
  return record_.stamp;
}

void LidarRecording::deliver() {
  driver_.on_datagram(record_.payload, record_.destination_port, record_.stamp,
                      record_.source.value_or(Ipv4Address{}));
  have_record_ = false;
}

}  // namespace convexcut::recording
