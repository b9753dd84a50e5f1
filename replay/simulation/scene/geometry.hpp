// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "replay/simulation/scene/bounds.hpp"
#include "replay/simulation/scene/four_boxes.hpp"
#include "replay/simulation/scene/ray.hpp"
#include "replay/simulation/scene/shapes.hpp"

namespace convexcut::simulation {

struct Primitive {
  Shape shape;
  std::uint32_t surface = kNoSurface;
};

// Shapes that keep their places to each other, with a hierarchy of boxes over them, so that a ray
// is tried on few of them. Immutable. Coordinates within ±kLargestCoordinate.
class Geometry {
 public:
  Geometry() = default;
  explicit Geometry(std::vector<Primitive> primitives);

  // Replaces distance and surface of `hit`, and gives the shape, when one is met before
  // `hit.distance_m`; null otherwise.
  const Primitive* cast(const Ray& ray, Hit& hit) const noexcept;

  [[nodiscard]] const Bounds& bounds() const noexcept { return bounds_; }
  [[nodiscard]] const std::vector<Primitive>& primitives() const noexcept { return primitives_; }

 private:
  // Four children: each of them a node or a leaf of some primitives.
  struct Node {
    FourBoxes boxes = FourBoxes::nothing();
    std::array<std::uint32_t, 4> first{};  // primitive of a leaf, or node
    std::array<std::uint32_t, 4> count{};  // primitives; 0: a node
  };
  class Builder;

  std::vector<Primitive> primitives_;  // those of a leaf are neighbours
  std::vector<Node> nodes_;            // the first is the root
  Bounds bounds_;
};

[[nodiscard]] Vec3 normal_at(const Shape& shape, const Vec3& p) noexcept;
[[nodiscard]] Bounds bounds_of(const Shape& shape) noexcept;
[[nodiscard]] Shape placed(const Shape& shape, const RigidTransform& world_from_local);

}  // namespace convexcut::simulation
