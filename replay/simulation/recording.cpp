// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/recording.hpp"

#include <stdexcept>
#include <string>

#include <system_error>

#include "drivers/capture/capture_writer.hpp"
#include "replay/atomic_file.hpp"
#include "replay/simulation/truth/truth_writer.hpp"
#include "replay/simulation/wire/imu_files.hpp"
#include "replay/text.hpp"

namespace convexcut::simulation {
namespace {

void count(const SimulatedFiring& firing, bool dual, RecordingSummary& summary) {
  ++summary.firings;
  for (std::size_t laser = 0; laser < SimulatedFiring::kLasers; ++laser) {
    for (std::size_t echo = 0; echo < (dual ? 2U : 1U); ++echo) {
      const SimulatedReturn& r = firing.returns[echo][laser];
      // A firing with one echo says it twice.
      const bool again = echo > 0 && r.range_2mm == firing.returns[0][laser].range_2mm;
      if (r.range_2mm == 0 || again) continue;
      ++summary.returns;
      summary.ghosts += (r.flags & (kIsolatedGhost | kSpecularGhost)) != 0 ? 1U : 0U;
      summary.mixed += (r.flags & kMixedPixel) != 0 ? 1U : 0U;
    }
  }
}

void write_imus(const SimulationOptions& options, const std::filesystem::path& folder) {
  const RigImu imu(RigMotion(options.rig, options.seed), options.imu_errors, options.seed);
  const auto state = [&](Duration t) { return imu.state(t); };
  write_serial_imu(options.serial_imu, state, kStart, options.imu_period(), options.seed,
                   folder / "imu.pcap");
  write_can_imu(options.can_imu, state, kStart, options.imu_period(), options.seed,
                folder / "can.log");
}

// The line's rate is what the recording does not tell.
void write_config(const SimulationOptions& options, const std::filesystem::path& file) {
  replay::AtomicFile out(file);
  out.write(
      replay::format("[lidar]\nmodel = \"hdl32e\"\n\n[imu]\nbaud = %u\n", options.serial_imu.baud));
  out.commit();
}

RecordingSummary write_lidar(const Scene& scene, const SimulationOptions& options,
                             const std::filesystem::path& folder, Progress progress) {
  RecordingSummary summary;
  LidarStream stream(scene, options);
  ReturnsWriter truth(folder / "truth" / "returns.bin", options.lidar.dual, stream.firings());
  capture::CaptureWriter capture(folder / "lidar.pcap", capture::LinkKind::ethernet);
  const auto on_firing = [&](const SimulatedFiring& firing) {
    truth.write(firing);
    count(firing, options.lidar.dual, summary);
  };
  const auto on_datagram = [&](const Datagram& datagram) { write(datagram, capture); };
  while (stream.next(on_firing, on_datagram)) progress(++summary.packets, stream.packets());
  truth.finish();
  capture.close();
  return summary;
}

}  // namespace

RecordingSummary write_recording(const Scene& scene, const SimulationOptions& options,
                                 const std::filesystem::path& folder, Progress progress) {
  const std::filesystem::path truth = folder / "truth";
  std::error_code error;
  std::filesystem::create_directory(truth, error);
  if (error) throw std::runtime_error("cannot make " + truth.string() + ": " + error.message());
  write_imus(options, folder);
  write_config(options, folder / "convexcut.toml");
  write_poses(options, truth / "poses.csv");
  write_settings(scene, options, truth / "simulation.toml");
  return write_lidar(scene, options, folder, progress);
}

}  // namespace convexcut::simulation
