// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/scan/function_ref.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/simulation.hpp"

namespace convexcut::simulation {

// Of a recording, counted while it is written.
struct RecordingSummary {
  std::uint64_t packets = 0;  // the sensor's; some may have been lost on the way
  std::uint64_t firings = 0;
  std::uint64_t returns = 0;
  std::uint64_t ghosts = 0;  // isolated and specular
  std::uint64_t mixed = 0;
};

// Packets done and packets in all.
using Progress = FunctionRef<void(std::uint64_t, std::uint64_t)>;

// Writes what the sensors would have sent, and the truth, into a folder that exists: lidar.pcap,
// imu.pcap, can.log, convexcut.toml (what `convexcut process --config` needs to know of the rig)
// and truth/. The same scene, options and seed give the same bytes. Throws std::runtime_error of
// one line, and std::invalid_argument when an option is out of its range.
RecordingSummary write_recording(const Scene& scene, const SimulationOptions& options,
                                 const std::filesystem::path& folder, Progress progress);

}  // namespace convexcut::simulation
