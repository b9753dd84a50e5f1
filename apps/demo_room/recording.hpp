// SPDX-License-Identifier: Apache-2.0
//
// One simulated run, written as the files that real sensors would have left.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "apps/demo_room/lidar_simulator.hpp"
#include "apps/demo_room/rig_motion.hpp"
#include "apps/demo_room/scene.hpp"
#include "core/return_batch.hpp"
#include "core/time.hpp"
#include "replay/simulation/wire/imu_simulator.hpp"

namespace convexcut::sim {

struct RecordingOptions {
  Duration length = std::chrono::seconds{5};  // of lidar data
  // The IMUs are on before the lidar and stay on after it, so that each firing has an orientation.
  Duration imu_margin = std::chrono::milliseconds{200};
  std::uint64_t seed = 1;
  Furnishing furnishing = Furnishing::furnished;
  // With PPS the lidar counts UTC; without, from when it was switched on.
  PpsState pps = PpsState::locked;
  RigMotionOptions motion{};
  LidarOptions lidar{};
  simulation::SerialImuOptions serial_imu{};
  simulation::CanImuOptions can_imu{};
};

// Packets done and packets in all.
using Progress = std::function<void(std::uint64_t, std::uint64_t)>;

// Each file depends on the options alone: same options, same bytes. All throw
// capture::CaptureError or std::runtime_error (one line, names the file).
void write_lidar(const RecordingOptions& options, const std::filesystem::path& pcap,
                 const Progress& progress);
void write_serial_imu(const RecordingOptions& options, const std::filesystem::path& pcap);
void write_can_imu(const RecordingOptions& options, const std::filesystem::path& log);

// lidar.pcap, imu.pcap and can.log in a folder, which is made when it is not there.
void write_recording(const RecordingOptions& options, const std::filesystem::path& folder,
                     const Progress& progress);

}  // namespace convexcut::sim
