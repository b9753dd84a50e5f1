// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/accuracy/methods.hpp"
#include "replay/evaluation/scan_figures.hpp"
#include "replay/simulation/labelled_scans.hpp"

namespace convexcut::bench {

// One simulated recording that methods are tried on.
struct Run {
  std::string experiment;
  std::string scene;
  int people = -1;  // instead of the scene's; −1: as the scene has it
  double tilt_deg = 0.0;
  Degrees heading{0.0};  // of the building's axes in frame level
  std::string variant;   // what is special, for the report
  simulation::LabelledScanOptions options{};
  std::size_t judge_every = 1;          // scans
  std::size_t judge_patches_every = 0;  // scans; 0: never
  std::size_t merge = 1;                // scans that are judged as one cloud
  std::size_t most_scans = 1'000'000;
};

struct SurfaceErrors {
  std::string name;
  evaluation::SurfaceCounts counts;
};

// What a method made of a run.
struct Outcome {
  std::string method;
  evaluation::ScoreSummary points;
  evaluation::ScoreSummary settled;  // of scans from the second second on
  evaluation::PointCounts pooled;
  std::vector<SurfaceErrors> errors;  // of the surfaces with the most wrong points
  evaluation::ScoreSummary patches;
  evaluation::PatchCounts pooled_patches;
  evaluation::Summary dynamic_ratio;
  double milliseconds = 0.0;  // in all
  std::size_t scans = 0;      // labelled
};

// Labels every scan with every method. Throws std::runtime_error and SceneError.
[[nodiscard]] std::vector<Outcome> outcomes_of(const Run& run,
                                               const std::vector<NamedMethod>& methods);

}  // namespace convexcut::bench
