// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/encoder_sample.hpp"
#include "core/imu_sample.hpp"
#include "core/sink.hpp"
#include "drivers/can/bus_devices.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/recording/can_frames.hpp"
#include "drivers/recording/recorded_stream.hpp"
#include "drivers/recording/sample_tap.hpp"

namespace convexcut::recording {

// A recorded CAN bus with an Xsens IMU or the encoder of a stage on it, or both.
class CanRecording final : public RecordedStream {
 public:
  // Throws as CanFrames.
  CanRecording(const std::filesystem::path& file, const can::BusOptions& options,
               Sink<ImuSample>& samples, Sink<EncoderSample>& angles);

  [[nodiscard]] std::optional<HostTime> next_stamp() override;
  void deliver() override;
  void finish() override { devices_.flush(); }
  [[nodiscard]] std::string problem() const override { return input_.problem(); }
  [[nodiscard]] std::uint64_t bytes_read() const override { return input_.bytes_read(); }
  [[nodiscard]] std::uint64_t bytes_total() const override { return input_.bytes_total(); }

  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
  // By identifier, without flags.
  [[nodiscard]] const std::map<std::uint32_t, std::uint64_t>& frames_by_id() const noexcept {
    return frames_by_id_;
  }
  [[nodiscard]] std::uint64_t orientations() const noexcept { return tap_.orientations(); }
  [[nodiscard]] const can::CanImuCounters& counters() const noexcept {
    return devices_.imu().counters();
  }
  // Null when no encoder is used.
  [[nodiscard]] const can::EncoderDriver* encoder() const noexcept { return devices_.encoder(); }
  // What was found, for messages to people.
  [[nodiscard]] std::string summary() const;

 private:
  CanFrames input_;
  SampleTap tap_;
  can::BusDevices devices_;
  can::CanFrame frame_;
  bool have_frame_ = false;
  std::uint64_t frames_ = 0;
  std::map<std::uint32_t, std::uint64_t> frames_by_id_;
};

}  // namespace convexcut::recording
