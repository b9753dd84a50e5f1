// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "config/config.hpp"
#include "core/encoder_sample.hpp"
#include "daemon/sources/null_sink.hpp"
#include "drivers/recording/can_recording.hpp"
#include "replay/info/sample_inspector.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {

// What is in a recording of a CAN bus: an IMU's samples, a stage's angles. Throws
// std::runtime_error of one line without any frame.
class CanInfo {
 public:
  CanInfo(const std::filesystem::path& file, const config::Config& config);

  void print() const;

  [[nodiscard]] JsonObject json() const;

 private:
  [[nodiscard]] std::uint64_t angles() const {
    return recording_.encoder() != nullptr ? recording_.encoder()->counters().samples.value() : 0;
  }

  std::filesystem::path file_;
  SampleInspector samples_;
  daemon::NullSink<EncoderSample> angles_;
  recording::CanRecording recording_;
};

}  // namespace convexcut::replay
