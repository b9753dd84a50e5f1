// SPDX-License-Identifier: Apache-2.0
//
// The robust method, its window full, beside Algorithm 1 with Qhull on the same revolutions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/convex_cut/measure.hpp"

namespace convexcut::bench {

struct RobustResult {
  std::string scene;
  std::size_t points = 0;  // of a revolution
  // qhull, robust, robust_at_once: until the labels of the revolutions before are there,
  // robust_thrifty: those and what is learnt from every second revolution, a revolution's share.
  std::vector<Timing> timings;
  std::size_t voxels = 0;  // of the window
  [[nodiscard]] double ratio() const { return timings[0].median_ms / timings[1].median_ms; }
};

// One of the simulator's scenes, seen by a lidar that leans by 30° and turns by 6° a revolution.
// One thread. Throws simulation::SceneError.
[[nodiscard]] RobustResult compare_robust(const std::string& scene, unsigned rounds);

}  // namespace convexcut::bench
