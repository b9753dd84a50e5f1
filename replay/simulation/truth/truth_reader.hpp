// SPDX-License-Identifier: Apache-2.0
//
// Reads the folder `truth` of a simulated recording (layout: truth_format.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/angle.hpp"
#include "core/pose_sample.hpp"
#include "core/time.hpp"
#include "drivers/wire.hpp"
#include "replay/simulation/lidar/simulated_firing.hpp"
#include "replay/simulation/rig/rig_motion.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {

// One line: which file, what is wrong with it, what was expected.
class TruthError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// simulation.toml, as far as a reader needs it.
struct TruthSettings {
  std::string scene;
  std::uint64_t seed = 0;
  HostTime start{};
  Duration length{};
  bool dual = false;
  double noise_m = 0.0;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  Degrees gravity_error;
  std::vector<SurfaceInfo> surfaces;
};

// One firing of returns.bin, read in place.
class TrueFiring {
 public:
  TrueFiring(wire::Bytes record, std::size_t echoes) noexcept : record_(record), echoes_(echoes) {}

  [[nodiscard]] HostTime time() const noexcept;    // of the first laser
  [[nodiscard]] Azimuth azimuth() const noexcept;  // as on the wire
  [[nodiscard]] std::size_t echoes() const noexcept { return echoes_; }
  // `laser`: 0 … 31 in firing order; `echo` < echoes(). The intensity is not kept.
  [[nodiscard]] SimulatedReturn at(std::size_t echo, std::size_t laser) const noexcept;

 private:
  wire::Bytes record_;
  std::size_t echoes_;
};

class TruthReader {
 public:
  // The folder `truth` itself, or the recording's that has it. Throws TruthError.
  explicit TruthReader(const std::filesystem::path& folder);
  ~TruthReader();
  TruthReader(TruthReader&&) noexcept;
  TruthReader& operator=(TruthReader&&) noexcept;

  [[nodiscard]] const TruthSettings& settings() const noexcept { return settings_; }

  // In the order of time; any of them at any time, from the page cache. Threads may share a reader.
  [[nodiscard]] std::size_t firings() const noexcept { return firings_; }
  [[nodiscard]] TrueFiring firing(std::size_t i) const noexcept;
  // The last one that does not begin after `time`; 0 when all do. There must be one.
  [[nodiscard]] std::size_t firing_at(HostTime time) const noexcept;

  // Ascending stamps, at least two.
  [[nodiscard]] std::span<const PoseSample> poses() const noexcept { return poses_; }
  // Between the neighbours; that of the first or last one outside of them.
  [[nodiscard]] Pose pose_at(HostTime time) const noexcept;

 private:
  class Mapping;

  void check_header(const std::filesystem::path& file);

  TruthSettings settings_;
  std::vector<PoseSample> poses_;
  std::unique_ptr<Mapping> returns_;
  std::size_t firings_ = 0;
  std::size_t echoes_ = 1;
};

}  // namespace convexcut::simulation
