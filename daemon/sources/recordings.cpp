// SPDX-License-Identifier: Apache-2.0
#include "daemon/sources/recordings.hpp"

#include <algorithm>
#include <stdexcept>

#include "config/loader.hpp"
#include "drivers/recording/pose_file.hpp"

namespace convexcut::daemon {

std::shared_ptr<const PositionTrack> recorded_positions(const RecordingPaths& paths) {
  if (paths.poses.empty()) return nullptr;
  return std::make_shared<const PositionTrack>(recording::read_poses(paths.poses));
}

Recordings::Recordings(const RecordingPaths& paths, const config::Config& config,
                       Sink<ReturnBatch>& returns, Sink<ImuSample>& samples,
                       Sink<EncoderSample>& angles)
    : paths_(paths),
      needs_orientation_(config.mount.orientation == config::MountOrientation::imu),
      needs_encoder_(config.encoder.use != config::EncoderUse::off) {
  if (needs_orientation_ && paths.imu.empty() && paths.can.empty()) {
    throw config::ConfigError(
        "mount.orientation is \"imu\" but no IMU is given: expected --imu FILE or --can FILE, or a "
        "fixed "
        "mount (--set mount.orientation=fixed, with mount.roll_deg, pitch_deg and yaw_deg)");
  }
  if (needs_encoder_ && paths.can.empty()) {
    throw config::ConfigError(
        "encoder.use is not \"off\" but no CAN bus is given: expected --can FILE with the "
        "encoder's "
        "messages (encoder.id)");
  }
  lidar_ = std::make_unique<recording::LidarRecording>(paths.lidar,
                                                       lidar_driver_options(config.lidar), returns);
  const auto start = lidar_->next_stamp();
  if (!start) check_lidar();
  lidar_start_ = *start;
  if (!paths.imu.empty()) {
    imu_ = std::make_unique<recording::ImuRecording>(paths.imu, imu_driver_options(config.imu),
                                                     lidar_start_ + paths.imu_start, samples);
  }
  if (!paths.can.empty()) {
    // One source of orientation: a serial IMU goes before one on the bus.
    Sink<ImuSample>& to = imu_ ? static_cast<Sink<ImuSample>&>(unused_samples_) : samples;
    can_ = std::make_unique<recording::CanRecording>(paths.can, bus_options(config), to, angles);
  }
}

std::vector<recording::RecordedStream*> Recordings::streams() const {
  std::vector<recording::RecordedStream*> all{lidar_.get()};
  if (imu_) all.push_back(imu_.get());
  if (can_) all.push_back(can_.get());
  return all;
}

HostTime Recordings::first_stamp() {
  HostTime first = lidar_start_;
  for (recording::RecordedStream* stream : streams()) {
    if (const auto stamp = stream->next_stamp()) first = std::min(first, *stamp);
  }
  return first;
}

std::optional<HostTime> Recordings::step() {
  recording::RecordedStream* oldest = nullptr;
  std::optional<HostTime> oldest_stamp;
  // The lidar comes first in the list and yields on a tie: orientations go before the points of the
  // same instant.
  for (recording::RecordedStream* stream : streams()) {
    const auto stamp = stream->next_stamp();
    if (stamp && (!oldest_stamp || *stamp <= *oldest_stamp)) {
      oldest = stream;
      oldest_stamp = stamp;
    }
  }
  if (oldest != nullptr) oldest->deliver();
  return oldest_stamp;
}

void Recordings::finish() {
  for (recording::RecordedStream* stream : streams()) stream->finish();
}

std::uint64_t Recordings::bytes_read() const {
  std::uint64_t bytes = 0;
  for (const recording::RecordedStream* stream : streams()) bytes += stream->bytes_read();
  return bytes;
}

std::uint64_t Recordings::bytes_total() const {
  std::uint64_t bytes = 0;
  for (const recording::RecordedStream* stream : streams()) bytes += stream->bytes_total();
  return bytes;
}

std::vector<std::string> Recordings::warnings() const {
  std::vector<std::string> lines;
  for (const recording::RecordedStream* stream : streams()) {
    if (std::string problem = stream->problem(); !problem.empty()) {
      lines.push_back(std::move(problem));
    }
  }
  if (imu_ && can_ && (!needs_encoder_ || can_->orientations() > 0)) {
    lines.push_back(paths_.can.string() +
                    ": its orientations are not used, orientation is taken from " +
                    paths_.imu.string());
  }
  return lines;
}

void Recordings::check_content() const {
  check_lidar();
  check_encoder();
  if (!needs_orientation_) return;
  if (imu_ && imu_->orientations() == 0) {
    throw std::runtime_error(paths_.imu.string() +
                             ": no orientation in it: expected MTData2 messages "
                             "with quaternion, Euler angles or rotation matrix; found " +
                             imu_->summary());
  }
  if (!imu_ && can_ && can_->orientations() == 0) {
    throw std::runtime_error(paths_.can.string() +
                             ": no orientation in it: expected quaternion or "
                             "Euler frames with the configured ids (can.quaternion_id …); found " +
                             can_->summary());
  }
}

void Recordings::check_encoder() const {
  if (!needs_encoder_ || can_->encoder()->counters().samples.value() > 0) return;
  const can::EncoderCounters& counters = can_->encoder()->counters();
  throw std::runtime_error(
      paths_.can.string() +
      ": no angle of the stage in it: expected frames with encoder.id; found " + can_->summary() +
      ", " + std::to_string(counters.frames.value()) + " of the encoder, " +
      std::to_string(counters.short_frames.value()) + " of these too short");
}

void Recordings::check_lidar() const {
  if (lidar_->driver().counters().data_packets.value() > 0) return;
  throw std::runtime_error(no_lidar_packets(paths_.lidar, *lidar_));
}

std::string no_lidar_packets(const std::filesystem::path& file,
                             const recording::LidarRecording& recording) {
  const velodyne::LidarCounters& counters = recording.driver().counters();
  std::string message = file.string() +
                        ": no lidar packets: expected UDP datagrams of 1206 bytes to the "
                        "data port (lidar.data_port), found " +
                        std::to_string(recording.reader().counters().datagrams.value()) +
                        " datagrams, " + std::to_string(counters.foreign.value()) +
                        " of them to other ports";
  if (const std::string problem = recording.problem(); !problem.empty()) message += "; " + problem;
  return message;
}

}  // namespace convexcut::daemon
