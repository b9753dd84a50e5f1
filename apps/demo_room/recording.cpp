// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/recording.hpp"

#include <stdexcept>
#include <string>

#include <system_error>

#include "drivers/capture/capture_writer.hpp"
#include "replay/simulation/wire/imu_files.hpp"
#include "replay/simulation/wire/lidar_link.hpp"

namespace convexcut::sim {
namespace {

simulation::Period imu_period(const RecordingOptions& options) {
  return {.from = -options.imu_margin, .length = options.length + 2 * options.imu_margin};
}

}  // namespace

void write_lidar(const RecordingOptions& options, const std::filesystem::path& pcap,
                 const Progress& progress) {
  LidarSimulator lidar(demo_room(options.furnishing), RigMotion(options.motion), options.lidar,
                       Random(options.seed, simulation::kLidarStream));
  simulation::LidarLink link({.pps = options.pps}, options.seed, simulation::kNetworkStream);
  capture::CaptureWriter out(pcap, capture::LinkKind::ethernet);
  const auto write = [&](const simulation::Datagram& datagram) {
    simulation::write(datagram, out);
  };
  const auto packets = static_cast<std::uint64_t>(options.length / LidarSimulator::kPacketPeriod);
  simulation::DataPacket packet;
  for (std::uint64_t i = 0; i < packets; ++i) {
    const Duration first = LidarSimulator::first_firing(i);
    const Duration complete = first + LidarSimulator::kPacketPeriod;
    lidar.fill(i, packet.blocks);
    link.send(packet, {.first_firing = first, .elapsed = complete, .complete = complete}, write);
    if (progress) progress(i + 1, packets);
  }
  link.finish(write);
  out.close();
}

void write_serial_imu(const RecordingOptions& options, const std::filesystem::path& pcap) {
  const RigMotion motion(options.motion);
  simulation::write_serial_imu(
      options.serial_imu, [&](Duration t) { return motion.state(t); }, simulation::kStart,
      imu_period(options), options.seed, pcap);
}

void write_can_imu(const RecordingOptions& options, const std::filesystem::path& log) {
  const RigMotion motion(options.motion);
  simulation::write_can_imu(
      options.can_imu, [&](Duration t) { return motion.state(t); }, simulation::kStart,
      imu_period(options), options.seed, log);
}

void write_recording(const RecordingOptions& options, const std::filesystem::path& folder,
                     const Progress& progress) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error("cannot make the folder " + folder.string() + ": " + error.message());
  }
  write_serial_imu(options, folder / "imu.pcap");
  write_can_imu(options, folder / "can.log");
  write_lidar(options, folder / "lidar.pcap", progress);
}

}  // namespace convexcut::sim
