// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "config/config.hpp"
#include "drivers/recording/lidar_recording.hpp"
#include "replay/info/lidar_inspector.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {

// What is in a recording of a lidar's packets. Throws std::runtime_error of one line when there are
// none.
class LidarInfo {
 public:
  LidarInfo(const std::filesystem::path& file, const config::Lidar& settings);

  void print() const;

  [[nodiscard]] JsonObject json() const;

 private:
  [[nodiscard]] const velodyne::LidarCounters& counters() const {
    return recording_.driver().counters();
  }
  [[nodiscard]] const SequencerCounters& order() const { return inspector_.order(); }
  [[nodiscard]] Duration duration() const { return inspector_.last() - inspector_.first(); }
  [[nodiscard]] const char* model() const;
  [[nodiscard]] std::uint64_t malformed() const;
  [[nodiscard]] std::string sentence() const;
  void print_revolutions() const;

  std::filesystem::path file_;
  LidarInspector inspector_;
  recording::LidarRecording recording_;
};

}  // namespace convexcut::replay
