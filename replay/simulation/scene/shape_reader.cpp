// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/shape_reader.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "config/value_text.hpp"
#include "replay/simulation/scene/mesh.hpp"

namespace convexcut::simulation {
namespace {

using Shapes = std::vector<Shape>;

constexpr double kFlatnessM = 1e-6;

Quaternion rotation_of(Fields& fields) {
  return to_quaternion({fields.degrees_or("roll_deg", 0.0), fields.degrees_or("pitch_deg", 0.0),
                        fields.degrees_or("yaw_deg", 0.0)});
}

Shapes read_box(Fields& fields) {
  const Quaternion rotation = rotation_of(fields);
  if (fields.has("center") || fields.has("size")) {
    const auto centre = fields.point("center");
    const auto size = fields.point("size", kSizeRange);
    if (!centre || !size) return {};
    return {Block({rotation, *centre}, *size / 2.0)};
  }
  const auto low = fields.point("min");
  const auto high = fields.point("max");
  if (!low || !high) return {};
  if ((low->array() >= high->array()).any()) {
    fields.report("max", "expected to be above min in all three");
    return {};
  }
  return {Block({rotation, (*low + *high) / 2.0}, (*high - *low) / 2.0)};
}

Shapes read_cylinder(Fields& fields) {
  const auto base = fields.point(fields.has("from") ? "from" : "base");
  const auto radius = fields.number("radius", kSizeRange);
  std::optional<Vec3> top;
  if (fields.has("from")) {
    top = fields.point("to");
  } else if (const auto height = fields.number("height", kSizeRange); height && base) {
    top = *base + Vec3(0.0, 0.0, *height);
  }
  const bool closed = fields.flag_or("closed", true);
  const auto part = fields.numbers_if_any("part_deg", 2, kAngleRange);
  if (!base || !top || !radius) return {};
  if ((*top - *base).norm() < kFlatnessM) {
    fields.report("to", "expected another point than from");
    return {};
  }
  const Cylinder whole(*base, *top, *radius,
                       closed ? Cylinder::Ends::closed : Cylinder::Ends::open);
  if (!part) return {whole};
  const double extent = (*part)[1] - (*part)[0];
  if (extent <= 0.0 || extent >= 360.0) {
    fields.report("part_deg", "expected the second angle to be 0 … 360 above the first");
    return {};
  }
  // From the x axis, or from z where the cylinder lies along x.
  const bool along_x = std::abs((*top - *base).normalized().x()) > 0.9;
  return {whole.part(along_x ? Vec3::UnitZ() : Vec3::UnitX(), Degrees{(*part)[0]}.to_radians(),
                     Degrees{extent}.to_radians())};
}

Shapes read_sphere(Fields& fields) {
  const auto centre = fields.point("center");
  const auto radius = fields.number("radius", kSizeRange);
  if (!centre || !radius) return {};
  return {Sphere(*centre, *radius)};
}

Shapes read_rectangle(Fields& fields) {
  const auto corner = fields.point("corner");
  const auto u = fields.point("u");
  const auto v = fields.point("v");
  if (!corner || !u || !v) return {};
  if (u->cross(*v).norm() < kFlatnessM) {
    fields.report("v", "expected another direction than u, neither of them 0");
    return {};
  }
  return {Flat(*corner, *u, *v, Flat::Form::parallelogram)};
}

Shapes read_polygon(Fields& fields) {
  std::vector<Vec3> loop;
  for (const auto& row : fields.rows("points", 3, 3)) loop.emplace_back(row[0], row[1], row[2]);
  if (loop.empty()) return {};
  const Vec3 normal = loop_normal(loop);
  if (normal.norm() < kFlatnessM) {
    fields.report("points", "expected corners of a polygon, found them on one line");
    return {};
  }
  for (const Vec3& corner : loop) {
    // A millimetre: corners are written by hand.
    if (std::abs(normal.normalized().dot(corner - loop.front())) > 1e-3) {
      fields.report("points", "expected corners in one plane, within 1 mm");
      return {};
    }
  }
  return {Polygon({loop})};
}

Mesh read_inline_mesh(Fields& fields) {
  Mesh mesh;
  for (const auto& row : fields.rows("vertices", 3, 3)) {
    mesh.vertices.emplace_back(row[0], row[1], row[2]);
  }
  if (mesh.vertices.empty()) return mesh;
  const Range indices{0.0, static_cast<double>(mesh.vertices.size()) - 1.0};
  for (const auto& row : fields.rows("faces", 3, 1, indices)) {
    Mesh::Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      triangle[i] = static_cast<std::uint32_t>(row[i]);
      if (row[i] != std::floor(row[i])) fields.report("faces", "expected whole numbers");
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

Shapes read_mesh_shape(Fields& fields, const std::filesystem::path& directory) {
  const RigidTransform place{rotation_of(fields), fields.point_or("position", Vec3::Zero())};
  const double scale = fields.number_or("scale", {0.0, 1000.0, true}, 1.0);
  Mesh mesh;
  if (fields.has("vertices")) {
    mesh = read_inline_mesh(fields);
  } else if (const auto file = fields.text("file", "an OBJ or PLY file")) {
    try {
      mesh = read_mesh(directory / *file);
    } catch (const MeshError& error) {
      fields.report("file", error.what());
    }
  }
  Shapes shapes;
  for (const Mesh::Triangle& triangle : mesh.triangles) {
    const Vec3 a = place * (scale * mesh.vertices[triangle[0]]);
    const Vec3 b = place * (scale * mesh.vertices[triangle[1]]);
    const Vec3 c = place * (scale * mesh.vertices[triangle[2]]);
    if ((b - a).cross(c - a).squaredNorm() == 0.0) continue;  // no ray meets it
    shapes.emplace_back(Flat(a, b - a, c - a, Flat::Form::triangle));
  }
  return shapes;
}

Shapes read_shapes(std::string_view kind, Fields& fields, const std::filesystem::path& directory) {
  if (kind == "box") return read_box(fields);
  if (kind == "cylinder") return read_cylinder(fields);
  if (kind == "sphere") return read_sphere(fields);
  if (kind == "rectangle") return read_rectangle(fields);
  if (kind == "polygon") return read_polygon(fields);
  return read_mesh_shape(fields, directory);
}

}  // namespace

SurfaceInfo read_surface(Fields& fields, SurfaceInfo otherwise) {
  SurfaceInfo info;
  info.name = fields.text_or("name", std::move(otherwise.name));
  info.label = fields.choice_or("label", kLabelNames, otherwise.label);
  info.reflectivity = fields.number_or("reflectivity", kPartRange, otherwise.reflectivity);
  info.material = fields.choice_or("material", kMaterialNames, otherwise.material);
  return info;
}

std::vector<Item> read_shape(std::string_view kind, Fields fields, std::string_view default_name,
                             const std::filesystem::path& directory) {
  const SurfaceInfo otherwise{std::string(default_name), SurfaceLabel::object, 0.5};
  Item item{read_surface(fields, otherwise), read_shapes(kind, fields, directory), fields.line()};
  fields.finish();
  if (item.shapes.empty()) return {};
  return {std::move(item)};
}

}  // namespace convexcut::simulation
