// SPDX-License-Identifier: Apache-2.0
//
// Wavefront OBJ: "v x y z" and "f v/vt/vn …" lines; all others are about looks and are passed over.
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include <system_error>

#include "replay/simulation/scene/mesh.hpp"
#include "replay/simulation/scene/mesh_parsing.hpp"

namespace convexcut::simulation {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view content, std::string_view name) : rest_(content), name_(name) {}

  Mesh read() {
    while (!rest_.empty()) {
      ++line_;
      std::string_view line = take_line(rest_);
      const std::string_view kind = take_word(line);
      if (kind == "v") read_vertex(line);
      if (kind == "f") read_face(line);
      if (mesh_.triangles.size() > kMostTriangles) fail("more than 5,000,000 triangles");
    }
    if (mesh_.triangles.empty()) {
      throw MeshError(std::string(name_) + ": no faces (lines \"f …\"), expected an OBJ file");
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw MeshError(std::string(name_) + ':' + std::to_string(line_) + ": " + what);
  }

  void read_vertex(std::string_view line) {
    Vec3 vertex;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto number = parse<double>(take_word(line));
      if (!number || !is_coordinate(*number)) fail("expected three numbers after v");
      vertex[axis] = *number;
    }
    mesh_.vertices.push_back(vertex);
  }

  void read_face(std::string_view line) {
    polygon_.clear();
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const auto index = parse<std::int64_t>(word.substr(0, word.find('/')));
      // Counted from 1, or backwards from the last one as −1.
      const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
      if (!index || *index == 0 || *index > count || *index < -count) {
        fail("expected numbers of vertices above this line after f");
      }
      polygon_.push_back(static_cast<std::uint32_t>(*index > 0 ? *index - 1 : count + *index));
    }
    if (polygon_.size() < 3) fail("expected at least three vertices after f");
    add_fan(polygon_, mesh_);
  }

  std::string_view rest_;
  std::string_view name_;
  std::size_t line_ = 0;
  Mesh mesh_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

Mesh read_obj(std::string_view content, std::string_view name) {
  return ObjReader(content, name).read();
}

Mesh read_mesh(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension != ".obj" && extension != ".ply") {
    throw MeshError(file.string() + ": expected a file named .obj or .ply");
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw MeshError(file.string() + ": is a directory, expected an OBJ or PLY file");
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) throw MeshError(file.string() + ": cannot open: " + std::strerror(errno));
  const std::string content(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw MeshError(file.string() + ": cannot read: " + std::strerror(errno));
  return extension == ".obj" ? read_obj(content, file.string()) : read_ply(content, file.string());
}

}  // namespace convexcut::simulation
