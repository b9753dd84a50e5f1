// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "replay/atomic_file.hpp"
#include "replay/simulation/lidar/simulated_firing.hpp"
#include "replay/simulation/simulation.hpp"

namespace convexcut::simulation {

// Writes returns.bin. Throws std::runtime_error of one line.
class ReturnsWriter {
 public:
  ReturnsWriter(std::filesystem::path file, bool dual, std::uint64_t firings);

  // Exactly `firings` of them, in order.
  void write(const SimulatedFiring& firing);
  void finish();

 private:
  void flush();

  replay::AtomicFile out_;
  std::size_t echoes_;
  std::string buffer_;
};

// poses.csv, over the time that the IMU is on.
void write_poses(const SimulationOptions& options, const std::filesystem::path& file);

// simulation.toml.
void write_settings(const Scene& scene, const SimulationOptions& options,
                    const std::filesystem::path& file);

}  // namespace convexcut::simulation
