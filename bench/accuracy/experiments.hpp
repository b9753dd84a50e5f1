// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/accuracy/methods.hpp"
#include "bench/accuracy/run.hpp"

namespace convexcut::bench {

struct ExperimentOptions {
  bool quick = false;
  std::uint64_t first_seed = 101;
  std::string only;           // the name of one experiment; empty: all
  std::string scene, method;  // only these; empty: all
  double tilt_deg = -1.0;     // only this; negative: all
};

// Runs that are compared with each other, and what is tried on them.
struct Experiment {
  std::vector<Run> runs;
  std::vector<NamedMethod> methods;
};

// scenes: all shipped scenes, tilt 0/30/60°, several seeds, all methods.
// ghosts, gravity, dynamic: what each disturbance costs. mirror: how much of an image is kept.
// ablation: robust without each of its parts. office, cafe, moving: the paper's experiments.
[[nodiscard]] std::vector<Experiment> experiments(const ExperimentOptions& options);

}  // namespace convexcut::bench
