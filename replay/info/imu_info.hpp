// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "config/config.hpp"
#include "drivers/recording/imu_recording.hpp"
#include "drivers/xsens/mt_statistics.hpp"
#include "replay/info/sample_inspector.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {

// What is in a recording of a serial IMU. Throws std::runtime_error of one line without any frame.
class ImuInfo {
 public:
  ImuInfo(const std::filesystem::path& file, const config::Imu& settings);

  void print() const;

  [[nodiscard]] JsonObject json() const;

 private:
  [[nodiscard]] std::string devices() const;

  std::filesystem::path file_;
  SampleInspector samples_;
  xsens::MtStatistics statistics_;
  recording::ImuRecording recording_;
};

}  // namespace convexcut::replay
