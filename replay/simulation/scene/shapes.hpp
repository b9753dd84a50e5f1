// SPDX-License-Identifier: Apache-2.0
//
// The shapes that surfaces are made of, exact. All are met from both sides: a block can be a room.
//
// meet() gives the smallest distance along the ray that is at least the ray's minimum and below
// `nearest`, or infinity. normal_at() is for a point on the shape, unit, either way. placed() is
// the shape moved by world_from_local.
#pragma once

#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

#include "core/geometry.hpp"
#include "replay/simulation/scene/bounds.hpp"
#include "replay/simulation/scene/ray.hpp"

namespace convexcut::simulation {

inline constexpr double kNoHit = std::numeric_limits<double>::infinity();

// A parallelogram or triangle, of a corner and the two edges that leave it.
class Flat {
 public:
  enum class Form : bool { parallelogram, triangle };
  Flat(Vec3 corner, Vec3 edge_u, Vec3 edge_v, Form form) noexcept;

  [[nodiscard]] double meet(const Ray& ray, double nearest) const noexcept;
  [[nodiscard]] Vec3 normal_at(const Vec3& p) const noexcept;
  [[nodiscard]] Bounds bounds() const noexcept;
  [[nodiscard]] Flat placed(const RigidTransform& world_from_local) const noexcept;

 private:
  Vec3 corner_;
  Vec3 edge_u_;
  Vec3 edge_v_;
  Vec3 normal_;  // unit
  Form form_;
};

// A plane polygon with holes: what lies inside an odd number of the loops.
class Polygon {
 public:
  // Each loop has at least three corners; all lie in the plane through the first loop's corners,
  // which do not lie on one line.
  explicit Polygon(std::vector<std::vector<Vec3>> loops);

  [[nodiscard]] double meet(const Ray& ray, double nearest) const noexcept;
  [[nodiscard]] Vec3 normal_at(const Vec3& p) const noexcept;
  [[nodiscard]] Bounds bounds() const noexcept;
  [[nodiscard]] Polygon placed(const RigidTransform& world_from_local) const;

 private:
  struct Edge {  // in the polygon's own axes
    double from_u, from_v, to_u, to_v;
  };
  [[nodiscard]] bool contains(double u, double v) const noexcept;

  std::vector<std::vector<Vec3>> loops_;
  std::vector<Edge> edges_;
  Vec3 normal_;
  Vec3 axis_u_;
  Vec3 axis_v_;
  double offset_;  // of the plane along its normal
};

// The normal of the plane that fits a loop (Newell's), as long as twice its area.
[[nodiscard]] Vec3 loop_normal(const std::vector<Vec3>& loop) noexcept;

// A box in any orientation.
class Block {
 public:
  Block(const RigidTransform& world_from_block, Vec3 half_size) noexcept;

  [[nodiscard]] double meet(const Ray& ray, double nearest) const noexcept;
  [[nodiscard]] Vec3 normal_at(const Vec3& p) const noexcept;
  [[nodiscard]] Bounds bounds() const noexcept;
  [[nodiscard]] Block placed(const RigidTransform& world_from_local) const noexcept;

 private:
  [[nodiscard]] Vec3 turned(const Vec3& direction) const noexcept {
    return is_upright_ ? direction : Vec3(block_from_world_ * direction);
  }

  Eigen::Matrix3d block_from_world_;
  Vec3 centre_;
  Vec3 half_size_;
  bool is_upright_;  // along the axes: most are
};

// A cylinder of any direction: closed by two discs, or an open tube, or a part of its mantle.
class Cylinder {
 public:
  enum class Ends : bool { open, closed };
  // From the middle of one end to that of the other.
  Cylinder(Vec3 from, const Vec3& to, double radius, Ends ends) noexcept;
  // Of the mantle only what turns from `zero` about the axis by `from` … `from` + `extent`;
  // 0 < extent < 360°.
  [[nodiscard]] Cylinder part(const Vec3& zero, Radians from, Radians extent) const noexcept;

  [[nodiscard]] double meet(const Ray& ray, double nearest) const noexcept;
  [[nodiscard]] Vec3 normal_at(const Vec3& p) const noexcept;
  [[nodiscard]] Bounds bounds() const noexcept;
  [[nodiscard]] Cylinder placed(const RigidTransform& world_from_local) const noexcept;

 private:
  [[nodiscard]] double meet_mantle(const Ray& ray, double nearest) const noexcept;
  [[nodiscard]] double meet_ends(const Ray& ray, double nearest) const noexcept;
  [[nodiscard]] double reach(const Vec3& direction) const noexcept;

  Vec3 from_;
  Vec3 axis_;                           // unit
  Vec3 middle_of_part_ = Vec3::Zero();  // unit; the direction of the part's middle
  double length_;
  double radius_;
  double cos_half_part_ = -2.0;  // of half of the part's extent; -2: the whole mantle
  Ends ends_;
};

class Sphere {
 public:
  Sphere(Vec3 centre, double radius) noexcept;

  [[nodiscard]] double meet(const Ray& ray, double nearest) const noexcept;
  [[nodiscard]] Vec3 normal_at(const Vec3& p) const noexcept;
  [[nodiscard]] Bounds bounds() const noexcept;
  [[nodiscard]] Sphere placed(const RigidTransform& world_from_local) const noexcept;

 private:
  Vec3 centre_;
  double radius_;
};

using Shape = std::variant<Flat, Polygon, Block, Cylinder, Sphere>;

// What `use` makes of the shape; as std::visit, and never throws where `use` does not.
template <class Use>
auto with(const Shape& shape, const Use& use) {
  if (const auto* flat = std::get_if<Flat>(&shape)) return use(*flat);
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return use(*polygon);
  if (const auto* block = std::get_if<Block>(&shape)) return use(*block);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return use(*cylinder);
  return use(*std::get_if<Sphere>(&shape));
}

}  // namespace convexcut::simulation
