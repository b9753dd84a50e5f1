// SPDX-License-Identifier: Apache-2.0
//
// The recordings of one drive, opened and joined to the drivers as a configuration asks.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "core/encoder_sample.hpp"
#include "core/imu_sample.hpp"
#include "core/return_batch.hpp"
#include "core/scan/position_track.hpp"
#include "core/sink.hpp"
#include "daemon/sources/driver_options.hpp"
#include "daemon/sources/null_sink.hpp"
#include "drivers/recording/can_recording.hpp"
#include "drivers/recording/imu_recording.hpp"
#include "drivers/recording/lidar_recording.hpp"

namespace convexcut::daemon {

struct RecordingPaths {
  std::filesystem::path lidar;
  std::filesystem::path imu;    // empty: none
  std::filesystem::path can;    // empty: none
  std::filesystem::path poses;  // of the lidar in a world; empty: none
  // Of a raw .bin IMU stream: its first sample, relative to the first lidar packet.
  Duration imu_start{0};
};

// The way of the lidar by the poses of a recording; null when there are none. Throws
// std::runtime_error of one line.
[[nodiscard]] std::shared_ptr<const PositionTrack> recorded_positions(const RecordingPaths& paths);

// What to say of a recording that was read without finding any: one line.
[[nodiscard]] std::string no_lidar_packets(const std::filesystem::path& file,
                                           const recording::LidarRecording& recording);

class Recordings {
 public:
  // Opens all of them. Throws capture::CaptureError or std::runtime_error of one line: missing,
  // empty, not a recording of this kind, no lidar packet, no source of orientation or of the
  // stage's angle though the configuration needs one.
  Recordings(const RecordingPaths& paths, const config::Config& config, Sink<ReturnBatch>& returns,
             Sink<ImuSample>& samples, Sink<EncoderSample>& angles);

  [[nodiscard]] const velodyne::LidarDriver& lidar_driver() const noexcept {
    return lidar_->driver();
  }
  [[nodiscard]] const recording::ImuRecording* imu() const noexcept { return imu_.get(); }
  [[nodiscard]] const recording::CanRecording* can() const noexcept { return can_.get(); }

  // The lidar's first datagram, and the oldest record of all.
  [[nodiscard]] HostTime lidar_start() const noexcept { return lidar_start_; }
  [[nodiscard]] HostTime first_stamp();

  // The streams one by one, for a thread each: the lidar's, then the others'.
  [[nodiscard]] std::vector<recording::RecordedStream*> streams() const;

  // Delivers the record that is next in time over all streams (an IMU's before a lidar's of the
  // same instant) and returns its stamp; nothing at the end.
  std::optional<HostTime> step();
  // After step() gave nothing.
  void finish();

  [[nodiscard]] std::uint64_t bytes_read() const;
  [[nodiscard]] std::uint64_t bytes_total() const;

  // One line each about what was odd but not fatal, e.g. a file that stops inside a record.
  [[nodiscard]] std::vector<std::string> warnings() const;
  // After the end: throws std::runtime_error of one line when a recording turned out to hold
  // nothing of use: no valid lidar packet, no orientation, no angle of a stage that is used.
  void check_content() const;

 private:
  void check_lidar() const;
  void check_encoder() const;

  RecordingPaths paths_;
  bool needs_orientation_;
  bool needs_encoder_;
  NullSink<ImuSample> unused_samples_;
  std::unique_ptr<recording::LidarRecording> lidar_;
  std::unique_ptr<recording::ImuRecording> imu_;
  std::unique_ptr<recording::CanRecording> can_;
  HostTime lidar_start_{};
};

}  // namespace convexcut::daemon
