// SPDX-License-Identifier: Apache-2.0
//
// Reads point clouds in PCD v0.7
// (https://pointclouds.org/documentation/tutorials/pcd_file_format.html), DATA binary or ascii:
// ours, and any other that has x, y and z.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/cloud.hpp"

namespace convexcut::replay {

struct PcdCloud {
  std::vector<float> x, y, z;  // metres; not a number where the file says so
  // Empty when the file has none.
  std::vector<Label> label;
  std::vector<std::uint16_t> ring;
  std::vector<std::uint32_t> time_ns;  // after the scan's stamp

  [[nodiscard]] CloudView view() const noexcept { return {x, y, z}; }
};

// Fields x, y, z of type F and, where there are such, label (1 = structure), ring and time of type
// U or I; others are skipped. Throws std::runtime_error of one line that names the file and what
// was expected.
[[nodiscard]] PcdCloud read_pcd(const std::filesystem::path& file);

}  // namespace convexcut::replay
