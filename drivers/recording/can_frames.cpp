// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/can_frames.hpp"

#include "drivers/can/socketcan_layout.hpp"
#include "drivers/recording/file_kind.hpp"

namespace convexcut::recording {

CanFrames::CanFrames(const std::filesystem::path& file)
    : capture_(open_capture(file, capture::LinkKind::can,
                            "a candump -L log or a capture of link type CAN_SOCKETCAN (227)")),
      log_(capture_ ? nullptr : std::make_unique<can::CandumpReader>(file)) {}

bool CanFrames::next(can::CanFrame& frame) {
  if (log_) return log_->next(frame) == can::CandumpReader::Status::frame;
  capture::Record record;
  while (capture_->next(record) == capture::ReadStatus::record) {
    if (record.kind != capture::RecordKind::can) continue;
    if (can::decode_socketcan(record.payload, can::IdOrder::big_endian, record.stamp, frame) ==
        can::RecordStatus::ok) {
      return true;
    }
    ++malformed_records_;
  }
  return false;
}

std::string CanFrames::problem() const { return capture_ ? capture_->problem() : log_->problem(); }

std::string CanFrames::malformed() const {
  if (log_)
    return std::to_string(log_->counters().malformed_lines.value()) + " lines that are no frame";
  return std::to_string(malformed_records_) + " malformed records";
}

}  // namespace convexcut::recording
