// SPDX-License-Identifier: Apache-2.0
//
// Simulated scans with the truth of each point, one revolution after another, without files: the
// simulated bytes go through the drivers and the pipeline that recordings go through.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "config/config.hpp"
#include "core/scan/scan.hpp"
#include "core/time.hpp"
#include "replay/simulation/rig/rig_motion.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/simulation.hpp"

namespace convexcut::simulation {

// Where the orientation of the points comes from.
enum class Levelling : std::uint8_t {
  imu,    // the simulated serial IMU, with all that is wrong with it
  truth,  // the rig itself; of the IMU's errors only that of gravity
};

struct LabelledScanOptions {
  SimulationOptions simulation{};
  Levelling levelling = Levelling::imu;
  // Leaves out the revolutions that the recording's start and end cut off.
  bool whole_revolutions = true;
  // Range gate, cut azimuth and so on, as `process` has them. The serial rate of the IMU and the
  // model are set.
  config::Config config{};
};

// All columns are equally long. The labels of the method (scan.label) are all Label::other.
struct LabelledScan {
  LevelledScan scan;
  std::vector<SurfaceLabel> label;
  std::vector<std::uint16_t> surface;  // index into Scene::surfaces(), or kNoSurface
  std::vector<std::uint8_t> flags;     // kIsolatedGhost and so on
  std::vector<float> range_m;          // as measured
  std::vector<float> true_range_m;     // without noise and rounding
};

class LabelledScans {
 public:
  // Throws std::invalid_argument when an option is out of its range.
  LabelledScans(const Scene& scene, const LabelledScanOptions& options);
  LabelledScans(LabelledScans&&) noexcept;
  LabelledScans& operator=(LabelledScans&&) noexcept;
  ~LabelledScans();

  // False at the end, and `out` untouched. Reuse `out`: it keeps its memory.
  [[nodiscard]] bool next(LabelledScan& out);

  // Of the lidar in the world, at the true time. Frame level has the world's axes (but for the
  // IMU's errors) and the lidar as its origin: p_world = position_world + p_level.
  [[nodiscard]] Pose pose_at(HostTime time) const noexcept;
  [[nodiscard]] const Scene& scene() const noexcept;

 private:
  class Run;
  std::unique_ptr<Run> run_;
};

}  // namespace convexcut::simulation
