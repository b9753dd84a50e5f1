// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "replay/simulation/scene/bounds.hpp"
#include "replay/simulation/scene/eight_boxes.hpp"
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
  // `hit.distance_m`; null otherwise. `box_ray` is made of `ray`.
  const Primitive* cast(const Ray& ray, const BoxRay& box_ray, Hit& hit) const noexcept;
  // The same without the hierarchy: better for a handful of primitives.
  const Primitive* cast_on_each(const Ray& ray, Hit& hit) const noexcept;

  [[nodiscard]] const Bounds& bounds() const noexcept { return bounds_; }
  [[nodiscard]] const std::vector<Primitive>& primitives() const noexcept { return primitives_; }

 private:
  // Eight children at most, each in its box: primitives, or other nodes.
  struct Node {
    static constexpr std::uint32_t kIsNode = std::uint32_t{1} << 31U;
    EightBoxes boxes = EightBoxes::nothing();
    std::array<std::uint32_t, EightBoxes::kLanes> children{};  // index, and the bit
  };
  class Builder;

  std::vector<Primitive> primitives_;  // in the order of the hierarchy
  std::vector<Node> nodes_;            // the first is the root
  Bounds bounds_;
};

[[nodiscard]] Vec3 normal_at(const Shape& shape, const Vec3& p) noexcept;
[[nodiscard]] Bounds bounds_of(const Shape& shape) noexcept;
[[nodiscard]] Shape placed(const Shape& shape, const RigidTransform& world_from_local);

}  // namespace convexcut::simulation
