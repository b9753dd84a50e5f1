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
  for (std::size_t laser = 0; laser < Column::kLasers; ++laser) {
    for (std::size_t other = 0; other < Column::kLasers; ++other) {
      if (model.ring[other] + 1 == model.ring[laser]) below_[laser] = {nullptr, other, true};
      if (model.ring[other] == model.ring[laser] + 1) above_[laser] = {nullptr, other, true};
    }
  }
}

void Beam::add_echoes(const Neighbourhood& around, std::size_t laser, const SceneAt& scene,
                      const Optics& optics, Echoes& echoes) const noexcept {
  const Column& own = around.own;
  Rims rims;
  rims.sides = {
      {{&around.before, laser, true}, {&around.next, laser, true}, below_[laser], above_[laser]}};
  rims.sides[2].column = rims.sides[3].column = &own;
  const bool edge = radius_ > 0.0 && finds_edge(own, laser, scene, rims);
  if (own.met[laser]) {
    optics.trace(scene, own.rays[laser], own.hits[laser], edge ? kMiddleShare : 1.0, echoes);
  }
  if (!edge) return;
  for (std::size_t side = 0; side < kSides; ++side) {
    if (!rims.rims[side].cast) cast(own.rays[laser], side, scene, rims);
    const Rim& rim = rims.rims[side];
    if (rim.met) optics.trace(scene, rim.ray, rim.hit, kRimShare, echoes);
  }
}

bool Beam::finds_edge(const Column& own, std::size_t laser, const SceneAt& scene,
                      Rims& rims) const noexcept {
  for (std::size_t i = 0; i < kSides; ++i) {
    const Side& side = rims.sides[i];
    if (!side.exists ||
        same_plane(own, laser, side.column->met[side.laser], side.column->hits[side.laser],
                   side.column->points[side.laser])) {
      continue;
    }
    cast(own.rays[laser], i, scene, rims);
    const Rim& rim = rims.rims[i];
    if (!same_plane(own, laser, rim.met, rim.hit,
                    rim.ray.origin + rim.hit.distance_m * rim.ray.direction)) {
      return true;
    }
  }
  return false;
}

// Towards the neighbour; of the highest and the lowest ring, that have none on one side, away from
// the opposite one.
void Beam::cast(const Ray& middle, std::size_t side, const SceneAt& scene,
                Rims& rims) const noexcept {
  const bool exists = rims.sides[side].exists;
  const Side& towards = rims.sides[exists ? side : side ^ 1U];
  Vec3 aside = towards.column->rays[towards.laser].direction - middle.direction;
  aside -= aside.dot(middle.direction) * middle.direction;
  aside *= (exists ? radius_ : -radius_) / aside.norm();
  Rim& rim = rims.rims[side];
  rim.cast = true;
  rim.ray = middle;
  rim.ray.direction = (middle.direction + aside).normalized();
  rim.met = scene.cast(rim.ray, rim.hit);
}

}  // namespace convexcut::simulation
