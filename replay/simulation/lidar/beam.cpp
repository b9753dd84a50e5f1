// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/lidar/beam.hpp"

#include <cmath>

#include "drivers/velodyne/model.hpp"

namespace convexcut::simulation {
namespace {

// What is farther than this from the plane of a hit is on another surface.
constexpr double kOffPlane = 0.03;

// The middle of a beam and four places of its rim.
constexpr double kMiddleShare = 0.4;
constexpr double kRimShare = 0.15;

bool same_plane(const Column& own, std::size_t laser, bool other_met, const Hit& other,
                const Vec3& other_point) noexcept {
  const Hit& hit = own.hits[laser];
  if (!other_met || !own.met[laser]) return other_met == own.met[laser];
  return other.surface == hit.surface &&
         std::abs(hit.normal.dot(other_point - own.points[laser])) < kOffPlane;
}

}  // namespace

Beam::Beam(Radians divergence) : radius_(0.5 * divergence.value) {
  const velodyne::Model& model = velodyne::model_of(velodyne::ModelId::hdl32e);
  below_.fill(kNone);
  above_.fill(kNone);
  for (std::size_t laser = 0; laser < Column::kLasers; ++laser) {
    for (std::size_t other = 0; other < Column::kLasers; ++other) {
      if (model.ring[other] + 1 != model.ring[laser]) continue;
      below_[laser] = other;
      above_[other] = laser;
    }
  }
}

void Beam::add_echoes(const Neighbourhood& around, std::size_t laser, const SceneAt& scene,
                      const Optics& optics, Echoes& echoes) const noexcept {
  const Column& own = around.own;
  const unsigned sides = radius_ > 0.0 ? differing_sides(around, laser) : 0;
  if (sides == 0) {
    if (own.met[laser]) optics.trace(scene, own.rays[laser], own.hits[laser], 1.0, echoes);
    return;
  }
  Rims rims;
  const bool edge = finds_edge(around, laser, sides, scene, rims);
  if (own.met[laser]) {
    optics.trace(scene, own.rays[laser], own.hits[laser], edge ? kMiddleShare : 1.0, echoes);
  }
  if (!edge) return;
  for (std::size_t i = 0; i < kSides; ++i) {
    if (!rims[i].cast) cast(around, laser, i, scene, rims[i]);
    if (rims[i].met) optics.trace(scene, rims[i].ray, rims[i].hit, kRimShare, echoes);
  }
}

Beam::Side Beam::side(const Neighbourhood& around, std::size_t laser,
                      std::size_t which) const noexcept {
  switch (which) {
    case 0:
      return {&around.before, laser};
    case 1:
      return {&around.next, laser};
    case 2:
      return {&around.own, below_[laser]};
    default:
      return {&around.own, above_[laser]};
  }
}

unsigned Beam::differing_sides(const Neighbourhood& around, std::size_t laser) const noexcept {
  unsigned sides = 0;
  for (std::size_t i = 0; i < kSides; ++i) {
    const auto [column, other] = side(around, laser, i);
    if (other == kNone) continue;
    const bool same = same_plane(around.own, laser, column->met[other], column->hits[other],
                                 column->points[other]);
    if (!same) sides |= 1U << i;
  }
  return sides;
}

bool Beam::finds_edge(const Neighbourhood& around, std::size_t laser, unsigned sides,
                      const SceneAt& scene, Rims& rims) const noexcept {
  for (std::size_t i = 0; i < kSides; ++i) {
    if ((sides & (1U << i)) == 0) continue;
    Rim& rim = rims[i];
    cast(around, laser, i, scene, rim);
    if (!same_plane(around.own, laser, rim.met, rim.hit,
                    rim.ray.origin + rim.hit.distance_m * rim.ray.direction)) {
      return true;
    }
  }
  return false;
}

// Towards the neighbour; of the highest and the lowest ring, that have none on one side, away from
// the opposite one.
void Beam::cast(const Neighbourhood& around, std::size_t laser, std::size_t which,
                const SceneAt& scene, Rim& rim) const noexcept {
  const Ray& middle = around.own.rays[laser];
  const bool exists = side(around, laser, which).laser != kNone;
  const auto [column, other] = side(around, laser, exists ? which : which ^ 1U);
  Vec3 aside = column->rays[other].direction - middle.direction;
  aside -= aside.dot(middle.direction) * middle.direction;
  aside *= (exists ? radius_ : -radius_) / aside.norm();
  rim.cast = true;
  rim.ray = middle;
  rim.ray.direction = (middle.direction + aside).normalized();
  const double expected =
      around.own.met[laser]
          ? distance_to_plane(rim.ray, around.own.hits[laser].normal, around.own.points[laser])
          : kUnknownDistance;
  rim.met = cast_expecting(scene, rim.ray, expected, rim.hit);
}

}  // namespace convexcut::simulation
