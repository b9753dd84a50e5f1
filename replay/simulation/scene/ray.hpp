// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "core/geometry.hpp"

namespace convexcut::simulation {

// Frame world, metres: z is up.
struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();  // unit length
  // Surfaces nearer than this are not met. To go on behind a surface (glass), cast again with the
  // distance of its hit plus kBehindSurface.
  double min_distance_m = 0.0;
  double max_distance_m = std::numeric_limits<double>::infinity();
};

// Far enough behind a hit that rounding cannot meet the same surface again; no two surfaces of a
// scene need to be told apart below this.
inline constexpr double kBehindSurface = 1e-6;

inline constexpr std::uint32_t kNoSurface = 0xFFFF;

struct Hit {
  double distance_m = std::numeric_limits<double>::infinity();  // along the ray, from its origin
  Vec3 normal = Vec3::Zero();                                   // unit, towards the ray's origin
  std::uint32_t surface = kNoSurface;                           // index into Scene::surfaces()
};

// Where a ray goes on after a mirror; it starts at the hit.
[[nodiscard]] inline Ray mirrored(const Ray& ray, const Hit& hit) {
  const Vec3 direction = ray.direction - 2.0 * ray.direction.dot(hit.normal) * hit.normal;
  return {ray.origin + hit.distance_m * ray.direction, direction.normalized(), kBehindSurface,
          ray.max_distance_m - hit.distance_m};
}

}  // namespace convexcut::simulation
