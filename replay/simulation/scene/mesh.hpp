// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/geometry.hpp"

namespace convexcut::simulation {

// One line: the file, its line where it has lines, what was expected.
class MeshError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Mesh {
  using Triangle = std::array<std::uint32_t, 3>;
  std::vector<Vec3> vertices;  // finite, within ±1e6
  std::vector<Triangle> triangles;
};

// By the file's name: Wavefront OBJ (v and f; polygons become fans of triangles), or PLY (ascii and
// binary little-endian; vertex x y z, face vertex_indices). Throws MeshError.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& file);

// The same for contents in memory; `name` is for messages.
[[nodiscard]] Mesh read_obj(std::string_view content, std::string_view name);
[[nodiscard]] Mesh read_ply(std::string_view content, std::string_view name);

}  // namespace convexcut::simulation
