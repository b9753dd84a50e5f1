// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "replay/simulation/scene/bounds.hpp"
#include "replay/simulation/scene/eight_boxes.hpp"
#include "replay/simulation/scene/ray.hpp"
#include "replay/simulation/scene/shaft.hpp"
#include "replay/simulation/scene/shapes.hpp"

namespace convexcut::simulation {

struct Primitive {
  Shape shape;
  std::uint32_t surface = kNoSurface;
};

// What is nearest on a ray so far. Of surfaces at the same distance the first of the scene is met,
// then what has the lower number: whatever was tried first.
class Nearest {
 public:
  // What is nearer than this is looked for.
  explicit Nearest(double limit_m) noexcept : distance_m_(limit_m), before_m_(limit_m) {}

  // Takes the primitive if it is met nearer; whether it is.
  bool try_on(const Ray& ray, const Primitive& primitive, std::uint32_t number) noexcept {
    const double distance_m =
        with(primitive.shape, [&](const auto& shape) { return shape.meet(ray, before_m_); });
    return offer(distance_m, primitive, number);
  }
  bool offer(double distance_m, const Primitive& primitive, std::uint32_t number) noexcept {
    if (!(distance_m < before_m_)) return false;
    if (distance_m == distance_m_ && primitive_ != nullptr &&
        std::pair(primitive.surface, number) >= std::pair(primitive_->surface, number_)) {
      return false;
    }
    distance_m_ = distance_m;
    before_m_ = next_above(distance_m);
    primitive_ = &primitive;
    number_ = number;
    return true;
  }

  // Of what is met, or the limit.
  [[nodiscard]] double distance_m() const noexcept { return distance_m_; }
  [[nodiscard]] double before_m() const noexcept { return before_m_; }
  // Null: nothing is met.
  [[nodiscard]] const Primitive* primitive() const noexcept { return primitive_; }
  [[nodiscard]] std::uint32_t number() const noexcept { return number_; }

 private:
  // Of numbers that are not negative.
  static double next_above(double number) noexcept {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(number + 0.0) + 1);
  }

  double distance_m_;
  double before_m_;
  const Primitive* primitive_ = nullptr;
  std::uint32_t number_ = 0;
};

// Shapes that keep their places to each other, with a hierarchy of boxes over them, so that a ray
// is tried on few of them. Immutable. Coordinates within ±kLargestCoordinate.
class Geometry {
 public:
  Geometry() = default;
  explicit Geometry(std::vector<Primitive> primitives);

  // Tries all primitives that the ray may meet. `box_ray` is made of `ray`.
  void cast(const Ray& ray, const BoxRay& box_ray, Nearest& nearest) const noexcept;
  // The same without the hierarchy: better for a handful of primitives.
  void cast_on_each(const Ray& ray, Nearest& nearest) const noexcept;
  // Calls met(number, where a ray enters at the earliest, boxes, lane of its box) for all
  // primitives that rays of the shaft may meet.
  template <class Met>
  void for_each_in(const BoxShaft& shaft, Met&& met) const;

  [[nodiscard]] const Bounds& bounds() const noexcept { return bounds_; }
  [[nodiscard]] const std::vector<Primitive>& primitives() const noexcept { return primitives_; }

 private:
  // Of children that wait while a ray or shaft is followed: deeper than any hierarchy that the
  // builder makes, with seven a level.
  static constexpr std::size_t kMostWaiting = 512;
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

template <class Met>
void Geometry::for_each_in(const BoxShaft& shaft, Met&& met) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, kMostWaiting> waiting;  // not cleared
  waiting[0] = 0;
  for (std::size_t size = 1; size > 0;) {
    const Node& node = nodes_[waiting[--size]];
    shaft.meet(node.boxes, [&](std::size_t lane, float enter) {
      const std::uint32_t child = node.children[lane];
      if ((child & Node::kIsNode) != 0) {
        waiting[size++] = child & ~Node::kIsNode;
      } else {
        met(child, enter, node.boxes, lane);
      }
    });
  }
}

[[nodiscard]] Vec3 normal_at(const Shape& shape, const Vec3& p) noexcept;
[[nodiscard]] Bounds bounds_of(const Shape& shape) noexcept;
[[nodiscard]] Shape placed(const Shape& shape, const RigidTransform& world_from_local);

}  // namespace convexcut::simulation
