// SPDX-License-Identifier: Apache-2.0
//
// A labelled scan as a picture for people: seen from above, and as one vertical slice through the
// lidar with the convex hull that decides in it.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/angle.hpp"
#include "core/cloud.hpp"

namespace convexcut::replay {

struct PictureInput {
  CloudView cloud;               // frame level; the lidar is at the origin
  std::span<const Label> label;  // one a point, or empty: a cloud that is not labelled
  std::string title;             // printable ASCII
  // The slicing plane: contains z and the horizontal direction at this angle from x, towards y.
  Degrees slice_angle{0.0};
  double slice_half_width_m = 0.05;
};

// Writes a PNG of 1600 × 820 pixels; the file gets its name only when it is whole. The same input
// gives the same pixels. Points that are not finite, or are the origin itself (no return), are left
// out. Throws std::invalid_argument when the spans differ in length, and std::runtime_error (one
// line, names the file) when it cannot be written.
void render_picture(const PictureInput& input, const std::filesystem::path& png);

}  // namespace convexcut::replay
