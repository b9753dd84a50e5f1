// SPDX-License-Identifier: Apache-2.0
//
// Reads point clouds in PCD v0.7
// (https://pointclouds.org/documentation/tutorials/pcd_file_format.html), DATA binary or ascii:
// ours, and any other that has x, y and z.
#pragma once

#include <filesystem>
#include <vector>

#include "core/cloud.hpp"

namespace convexcut::replay {

struct PcdCloud {
  std::vector<float> x, y, z;  // metres; not a number where the file says so
  std::vector<Label> label;    // empty when the file has none

  [[nodiscard]] CloudView view() const noexcept { return {x, y, z}; }
};

// Fields x, y, z of type F and, when there is one, label of type U or I (1 = structure); others are
// skipped. Throws std::runtime_error of one line that names the file and what was expected.
[[nodiscard]] PcdCloud read_pcd(const std::filesystem::path& file);

}  // namespace convexcut::replay
