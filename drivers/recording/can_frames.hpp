// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "drivers/can/can_frame.hpp"
#include "drivers/can/candump_reader.hpp"
#include "drivers/capture/capture_reader.hpp"

namespace convexcut::recording {

// The frames of a recorded CAN bus: a candump log or a capture of link type CAN_SOCKETCAN. One
// thread.
class CanFrames {
 public:
  // Tells the two kinds by their first bytes. Throws capture::CaptureError or std::runtime_error:
  // missing, empty, a capture of something else.
  explicit CanFrames(const std::filesystem::path& file);

  // The next frame; false at the end. What is no frame is passed over and counted.
  [[nodiscard]] bool next(can::CanFrame& frame);

  // One line that says what is wrong with the file when it did not end regularly, otherwise empty.
  [[nodiscard]] std::string problem() const;
  // How many lines or records were no frame, for messages to people: "3 malformed records".
  [[nodiscard]] std::string malformed() const;
  // A candump log tells nothing of its progress: it is 0 of 0 bytes.
  [[nodiscard]] std::uint64_t bytes_read() const { return capture_ ? capture_->bytes_read() : 0; }
  [[nodiscard]] std::uint64_t bytes_total() const { return capture_ ? capture_->file_size() : 0; }

 private:
  std::unique_ptr<capture::CaptureReader> capture_;  // one of the two
  std::unique_ptr<can::CandumpReader> log_;
  std::uint64_t malformed_records_ = 0;
};

}  // namespace convexcut::recording
