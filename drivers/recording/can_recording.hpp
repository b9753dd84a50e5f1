// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/imu_sample.hpp"
#include "core/sink.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/can/can_imu_driver.hpp"
#include "drivers/can/candump_reader.hpp"
#include "drivers/capture/capture_reader.hpp"
#include "drivers/recording/recorded_stream.hpp"
#include "drivers/recording/sample_tap.hpp"

namespace convexcut::recording {

// A recorded CAN bus with an Xsens IMU on it: a candump log or a capture of link type
// CAN_SOCKETCAN.
class CanRecording final : public RecordedStream {
 public:
  // Tells the two kinds by their first bytes. Throws capture::CaptureError or std::runtime_error:
  // missing, empty, a capture of something else.
  CanRecording(const std::filesystem::path& file, const can::CanImuOptions& options,
               Sink<ImuSample>& sink);

  [[nodiscard]] std::optional<HostTime> next_stamp() override;
  void deliver() override;
  void finish() override { driver_.flush(); }
  [[nodiscard]] std::string problem() const override;
  // A candump log tells nothing of its progress: it is 0 of 0 bytes.
  [[nodiscard]] std::uint64_t bytes_read() const override {
    return capture_ ? capture_->bytes_read() : 0;
  }
  [[nodiscard]] std::uint64_t bytes_total() const override {
    return capture_ ? capture_->file_size() : 0;
  }

  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
  // By identifier, without flags.
  [[nodiscard]] const std::map<std::uint32_t, std::uint64_t>& frames_by_id() const noexcept {
    return frames_by_id_;
  }
  [[nodiscard]] std::uint64_t orientations() const noexcept { return tap_.orientations(); }
  [[nodiscard]] const can::CanImuCounters& counters() const noexcept { return driver_.counters(); }
  // What was found, for messages to people.
  [[nodiscard]] std::string summary() const;

 private:
  [[nodiscard]] bool read_frame();

  std::unique_ptr<capture::CaptureReader> capture_;  // one of the two
  std::unique_ptr<can::CandumpReader> log_;
  SampleTap tap_;
  can::CanImuDriver driver_;
  can::CanFrame frame_;
  bool have_frame_ = false;
  std::uint64_t frames_ = 0;
  std::uint64_t malformed_records_ = 0;
  std::map<std::uint32_t, std::uint64_t> frames_by_id_;
};

}  // namespace convexcut::recording
