// SPDX-License-Identifier: Apache-2.0
//
// How a ray finds its shape; geometry_builder.cpp makes the hierarchy.
#include "replay/simulation/scene/geometry.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>

namespace convexcut::simulation {
namespace {

// A child that is still to be looked at.
struct Entry {
  float enter;
  std::uint32_t first;
  std::uint32_t count;
};

// Deeper than any hierarchy that the builder makes, with three waiting children a level.
class Stack {
 public:
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  void push(const Entry& entry) noexcept { entries_[size_++] = entry; }
  Entry pop() noexcept { return entries_[--size_]; }
  // The nearest of the entries from `from` on comes last.
  void sort_from(std::size_t from) noexcept {
    for (std::size_t i = from + 1; i < size_; ++i) {
      const Entry entry = entries_[i];
      std::size_t place = i;
      for (; place > from && entries_[place - 1].enter < entry.enter; --place) {
        entries_[place] = entries_[place - 1];
      }
      entries_[place] = entry;
    }
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

 private:
  std::array<Entry, 256> entries_;
  std::size_t size_ = 0;
};

template <class Node>
void push_met_children(const Node& node, const BoxRay& ray, float limit, Stack& stack) {
  const std::size_t before = stack.size();
  ray.meet(node.boxes, limit, [&](std::size_t lane, float enter) {
    stack.push({enter, node.first[lane], node.count[lane]});
  });
  stack.sort_from(before);
}

}  // namespace

const Primitive* Geometry::cast(const Ray& ray, Hit& hit) const noexcept {
  if (nodes_.empty()) return nullptr;
  const BoxRay box_ray(ray);
  const Primitive* met = nullptr;
  double nearest = std::min(hit.distance_m, ray.max_distance_m);
  float limit = BoxRay::limit_of(nearest);
  Stack stack;
  push_met_children(nodes_.front(), box_ray, limit, stack);
  while (!stack.empty()) {
    const Entry entry = stack.pop();
    if (entry.enter > limit) continue;
    if (entry.count == 0) {
      push_met_children(nodes_[entry.first], box_ray, limit, stack);
      continue;
    }
    for (std::uint32_t i = 0; i < entry.count; ++i) {
      const Primitive& primitive = primitives_[entry.first + i];
      const double distance =
          std::visit([&](const auto& shape) { return shape.meet(ray, nearest); }, primitive.shape);
      if (distance < nearest) {
        nearest = distance;
        met = &primitive;
      }
    }
    limit = BoxRay::limit_of(nearest);
  }
  if (met != nullptr) {
    hit.distance_m = nearest;
    hit.surface = met->surface;
  }
  return met;
}

Vec3 normal_at(const Shape& shape, const Vec3& p) noexcept {
  return std::visit([&](const auto& each) { return each.normal_at(p); }, shape);
}

Bounds bounds_of(const Shape& shape) noexcept {
  return std::visit([](const auto& each) { return each.bounds(); }, shape);
}

Shape placed(const Shape& shape, const RigidTransform& world_from_local) {
  return std::visit([&](const auto& each) -> Shape { return each.placed(world_from_local); },
                    shape);
}

}  // namespace convexcut::simulation
