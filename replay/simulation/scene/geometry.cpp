// SPDX-License-Identifier: Apache-2.0
//
// How a ray finds its shape; geometry_builder.cpp makes the hierarchy.
#include "replay/simulation/scene/geometry.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <variant>

namespace convexcut::simulation {
namespace {

// A child that is still to be looked at: where the ray enters its box, as bits of a float that is
// not negative, above its index. So entries are in the order of distance as numbers, and are
// written and read in one piece.
using Entry = std::uint64_t;

Entry entry_of(float enter, std::uint32_t child) noexcept {
  return Entry{std::bit_cast<std::uint32_t>(enter)} << 32U | child;
}

}  // namespace

void Geometry::cast_on_each(const Ray& ray, Nearest& nearest) const noexcept {
  for (std::uint32_t i = 0; i < primitives_.size(); ++i) nearest.try_on(ray, primitives_[i], i);
}

void Geometry::cast(const Ray& ray, const BoxRay& box_ray, Nearest& nearest) const noexcept {
  if (nodes_.empty()) return;
  float limit = BoxRay::limit_of(nearest.distance_m());
  std::array<Entry, kMostWaiting> stack;  // not cleared: that takes longer than all the rest
  stack[0] = entry_of(0.0F, Node::kIsNode);
  std::size_t size = 1;
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry > entry_of(limit, ~std::uint32_t{0})) continue;
    const auto child = static_cast<std::uint32_t>(entry);
    if ((child & Node::kIsNode) == 0) {
      if (nearest.try_on(ray, primitives_[child], child)) {
        limit = BoxRay::limit_of(nearest.distance_m());
      }
      continue;
    }
    const Node& node = nodes_[child & ~Node::kIsNode];
    const std::size_t before = size;
    box_ray.meet(node.boxes, limit, [&](std::size_t lane, float enter) {
      // Sorted, the nearest of the node's children last.
      const Entry met = entry_of(enter, node.children[lane]);
      std::size_t place = size++;
      for (; place > before && stack[place - 1] < met; --place) stack[place] = stack[place - 1];
      stack[place] = met;
    });
  }
}

Vec3 normal_at(const Shape& shape, const Vec3& p) noexcept {
  return with(shape, [&](const auto& each) { return each.normal_at(p); });
}

Bounds bounds_of(const Shape& shape) noexcept {
  return with(shape, [](const auto& each) { return each.bounds(); });
}

Shape placed(const Shape& shape, const RigidTransform& world_from_local) {
  return std::visit([&](const auto& each) -> Shape { return each.placed(world_from_local); },
                    shape);
}

}  // namespace convexcut::simulation
