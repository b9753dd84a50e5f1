// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/can_recording.hpp"

#include "drivers/can/socketcan_layout.hpp"
#include "drivers/recording/file_kind.hpp"

namespace convexcut::recording {
CanRecording::CanRecording(const std::filesystem::path& file, const can::CanImuOptions& options,
                           Sink<ImuSample>& sink)
    : capture_(open_capture(file, capture::LinkKind::can,
                            "a candump -L log or a capture of link type CAN_SOCKETCAN (227)")),
      log_(capture_ ? nullptr : std::make_unique<can::CandumpReader>(file)),
      tap_(sink),
      driver_(options, tap_) {}

std::optional<HostTime> CanRecording::next_stamp() {
  if (!have_frame_) have_frame_ = read_frame();
  if (!have_frame_) return std::nullopt;
  return frame_.stamp;
}

bool CanRecording::read_frame() {
  if (log_) return log_->next(frame_) == can::CandumpReader::Status::frame;
  capture::Record record;
  while (capture_->next(record) == capture::ReadStatus::record) {
    if (record.kind != capture::RecordKind::can) continue;
    if (can::decode_socketcan(record.payload, can::IdOrder::big_endian, record.stamp, frame_) ==
        can::RecordStatus::ok) {
      return true;
    }
    ++malformed_records_;
  }
  return false;
}

void CanRecording::deliver() {
  ++frames_;
  ++frames_by_id_[frame_.id];
  driver_.on_frame(frame_);
  have_frame_ = false;
}

std::string CanRecording::problem() const {
  return capture_ ? capture_->problem() : log_->problem();
}

std::string CanRecording::summary() const {
  const std::uint64_t malformed =
      log_ ? log_->counters().malformed_lines.value() : malformed_records_;
  return std::to_string(frames_) + " frames, " + std::to_string(malformed) +
         (log_ ? " lines that are no frame" : " malformed records");
}

}  // namespace convexcut::recording
