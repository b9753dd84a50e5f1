// SPDX-License-Identifier: Apache-2.0
//
// PLY (Turk, "The PLY Polygon File Format", 1994), ascii and binary little-endian.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "replay/simulation/scene/mesh.hpp"
#include "replay/simulation/scene/mesh_parsing.hpp"

namespace convexcut::simulation {
namespace {

static_assert(std::endian::native == std::endian::little, "binary values are in the host's order");

struct Type {
  std::string_view name;
  char kind;  // 'i', 'u', 'f'
  std::size_t size;
};
constexpr std::array<Type, 16> kTypes{{{"char", 'i', 1},
                                       {"int8", 'i', 1},
                                       {"uchar", 'u', 1},
                                       {"uint8", 'u', 1},
                                       {"short", 'i', 2},
                                       {"int16", 'i', 2},
                                       {"ushort", 'u', 2},
                                       {"uint16", 'u', 2},
                                       {"int", 'i', 4},
                                       {"int32", 'i', 4},
                                       {"uint", 'u', 4},
                                       {"uint32", 'u', 4},
                                       {"float", 'f', 4},
                                       {"float32", 'f', 4},
                                       {"double", 'f', 8},
                                       {"float64", 'f', 8}}};

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* count_type = nullptr;  // of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

template <class Value>
double load(const char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double load(const Type& type, const char* bytes) {
  switch (type.size) {
    case 1:
      return type.kind == 'i' ? load<std::int8_t>(bytes) : load<std::uint8_t>(bytes);
    case 2:
      return type.kind == 'i' ? load<std::int16_t>(bytes) : load<std::uint16_t>(bytes);
    case 4:
      if (type.kind == 'f') return load<float>(bytes);
      return type.kind == 'i' ? load<std::int32_t>(bytes) : load<std::uint32_t>(bytes);
    default:
      return load<double>(bytes);
  }
}

class PlyReader {
 public:
  PlyReader(std::string_view content, std::string_view name) : rest_(content), name_(name) {}

  Mesh read() {
    read_header();
    for (const Element& element : elements_) {
      if (element.properties.empty() && element.count > 0) fail("an element without properties");
      for (std::size_t i = 0; i < element.count; ++i) read_one(element);
    }
    if (mesh_.triangles.empty()) fail("no faces, expected a mesh");
    for (const Mesh::Triangle& triangle : mesh_.triangles) {
      for (const std::uint32_t vertex : triangle) {
        if (vertex >= mesh_.vertices.size()) fail("a face of vertices that do not exist");
      }
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw MeshError(std::string(name_) + ": " + what);
  }
  [[noreturn]] void fail_in_header(const char* what) const {
    throw MeshError(std::string(name_) + ':' + std::to_string(line_) + ": " + what);
  }

  void read_header() {
    line_ = 1;
    if (take_line(rest_) != "ply") fail_in_header("expected \"ply\"");
    bool has_format = false;
    while (true) {
      if (rest_.empty()) fail_in_header("the header has no end_header");
      ++line_;
      std::string_view line = take_line(rest_);
      const std::string_view word = take_word(line);
      if (word == "end_header") break;
      if (word == "format") {
        read_format(take_word(line));
        has_format = true;
      } else if (word == "element") {
        read_element(line);
      } else if (word == "property") {
        read_property(line);
      } else if (!word.empty() && word != "comment" && word != "obj_info") {
        fail_in_header("expected format, element, property, comment or end_header");
      }
    }
    if (!has_format) fail_in_header("the header has no format");
  }

  void read_format(std::string_view format) {
    if (format != "ascii" && format != "binary_little_endian") {
      fail_in_header("expected format ascii or binary_little_endian");
    }
    binary_ = format != "ascii";
  }

  void read_element(std::string_view line) {
    const std::string_view name = take_word(line);
    const auto count = parse<std::uint64_t>(take_word(line));
    // Every element takes at least a byte, so that a wrong count cannot take memory or time.
    if (name.empty() || !count || *count > rest_.size()) {
      fail_in_header("expected an element's name and a count that the file can hold");
    }
    elements_.push_back({std::string(name), static_cast<std::size_t>(*count), {}});
  }

  const Type* type_of(std::string_view name) const {
    const auto* found = std::ranges::find(kTypes, name, &Type::name);
    if (found == kTypes.end()) fail_in_header("expected a type: char, uchar, … double");
    return found;
  }

  void read_property(std::string_view line) {
    if (elements_.empty()) fail_in_header("a property before the first element");
    Property property;
    std::string_view word = take_word(line);
    if (word == "list") {
      property.count_type = type_of(take_word(line));
      if (property.count_type->kind == 'f') fail_in_header("expected a whole number's type");
      word = take_word(line);
    }
    property.type = type_of(word);
    property.name = take_word(line);
    elements_.back().properties.push_back(std::move(property));
  }

  double take(const Type& type) {
    if (!binary_) {
      const std::string_view word = take_word(rest_);
      const auto number = parse<double>(word);
      if (!number) fail(word.empty() ? "ends before its elements do" : "expected a number");
      return *number;
    }
    if (rest_.size() < type.size) fail("ends before its elements do");
    const double value = load(type, rest_.data());
    rest_.remove_prefix(type.size);
    return value;
  }

  void read_one(const Element& element) {
    Vec3 vertex = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    for (const Property& property : element.properties) {
      if (property.count_type != nullptr) {
        read_list(property);
        const bool is_face = element.name == "face" &&
                             (property.name == "vertex_indices" || property.name == "vertex_index");
        if (is_face) add_face();
        continue;
      }
      const double value = take(*property.type);
      if (property.name == "x") vertex.x() = value;
      if (property.name == "y") vertex.y() = value;
      if (property.name == "z") vertex.z() = value;
    }
    if (element.name != "vertex") return;
    if (!is_coordinate(vertex.x()) || !is_coordinate(vertex.y()) || !is_coordinate(vertex.z())) {
      fail("expected x, y and z of each vertex");
    }
    mesh_.vertices.push_back(vertex);
  }

  void read_list(const Property& property) {
    list_.clear();
    const double count = take(*property.count_type);
    if (!(count >= 0.0 && count <= static_cast<double>(rest_.size()))) {
      fail("a list that is longer than the file");
    }
    for (double i = 0.0; i < count; ++i) list_.push_back(take(*property.type));
  }

  void add_face() {
    polygon_.clear();
    for (const double index : list_) {
      if (!(index >= 0.0 && index < 4294967295.0)) fail("a face of vertices that do not exist");
      polygon_.push_back(static_cast<std::uint32_t>(index));
    }
    add_fan(polygon_, mesh_);
    if (mesh_.triangles.size() > kMostTriangles) fail("more than 5,000,000 triangles");
  }

  std::string_view rest_;
  std::string_view name_;
  std::size_t line_ = 0;
  bool binary_ = false;
  std::vector<Element> elements_;
  Mesh mesh_;
  std::vector<double> list_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

Mesh read_ply(std::string_view content, std::string_view name) {
  return PlyReader(content, name).read();
}

}  // namespace convexcut::simulation
