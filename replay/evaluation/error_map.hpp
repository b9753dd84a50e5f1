// SPDX-License-Identifier: Apache-2.0
//
// Where a scan was judged wrongly: from above, and in the vertical slice with the most errors.
#pragma once

#include <span>
#include <string>

#include "core/cloud.hpp"
#include "replay/simulation/scene/surface_label.hpp"

namespace convexcut::evaluation {

struct ErrorMapInput {
  CloudView cloud;  // frame level; the lidar is at the origin
  std::span<const Label> result;
  std::span<const simulation::SurfaceLabel> truth;
};

// The bytes of a PNG of 1600 × 760 pixels. The same input gives the same bytes. Points of true
// label `none` are drawn as correct when they were removed, faintly when kept. Throws
// std::invalid_argument when the spans differ in length.
[[nodiscard]] std::string error_map_png(const ErrorMapInput& input);

}  // namespace convexcut::evaluation
