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

// Whether a ray that met `other`, or nothing, met the plane that the laser's middle ray met.
bool same_plane(const Column& own, std::size_t laser, bool other_met, const Hit& other,
                const Vec3& other_point) noexcept {
  const Hit& hit = own.hits[laser];
  if (!other_met || !own.met[laser]) return other_met == own.met[laser];
  return other.surface == hit.surface &&
         std::abs(hit.normal.dot(other_point - own.points[laser])) < kOffPlane;
}

bool same_plane(const Column& own, std::size_t laser, const Column& column, std::size_t other) {
  return same_plane(own, laser, column.met[other], column.hits[other], column.points[other]);
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

Beam::UprightSides Beam::upright_sides(const Column& column) const noexcept {
  UprightSides found{};
  if (radius_ <= 0.0) return found;
  const Neighbourhood around{column, column, column};
  for (std::size_t laser = 0; laser < Column::kLasers; ++laser) {
    for (const std::size_t side : {kBelow, kAbove}) {
      const std::size_t other = side == kBelow ? below_[laser] : above_[laser];
      if (other == kNone || same_plane(column, laser, column, other)) continue;
      Rims rims;
      if (finds_edge(around, laser, 1U << side, rims)) found[laser] |= 1U << side;
    }
  }
  return found;
}

Sides Beam::level_sides(const Neighbourhood& around, std::size_t laser) const noexcept {
  if (radius_ <= 0.0) return 0;
  Sides sides = 0;
  if (!same_plane(around.own, laser, around.before, laser)) sides |= 1U << kBefore;
  if (!same_plane(around.own, laser, around.next, laser)) sides |= 1U << kNext;
  return sides;
}

void Beam::add_echoes(const Neighbourhood& around, std::size_t laser, Sides sides,
                      const Optics& optics, Echoes& echoes) const noexcept {
  const Column& own = around.own;
  Rims rims;
  const bool edge = finds_edge(around, laser, sides, rims);
  if (own.met[laser]) {
    optics.trace(*own.around, laser, own.rays[laser], own.hits[laser], edge ? kMiddleShare : 1.0,
                 echoes);
  }
  if (!edge) return;
  for (std::size_t side = 0; side < kSides; ++side) {
    if (!rims[side].cast) cast(around, laser, side, rims[side]);
    if (rims[side].met)
      optics.trace(*own.around, laser, rims[side].ray, rims[side].hit, kRimShare, echoes);
  }
}

const Ray* Beam::neighbour(const Neighbourhood& around, std::size_t laser,
                           std::size_t side) const noexcept {
  if (side == kBefore) return &around.before.rays[laser];
  if (side == kNext) return &around.next.rays[laser];
  const std::size_t other = side == kBelow ? below_[laser] : above_[laser];
  return other == kNone ? nullptr : &around.own.rays[other];
}

bool Beam::finds_edge(const Neighbourhood& around, std::size_t laser, Sides sides,
                      Rims& rims) const noexcept {
  for (std::size_t side = 0; side < kSides; ++side) {
    if ((sides & (1U << side)) == 0) continue;
    Rim& rim = rims[side];
    cast(around, laser, side, rim);
    if (!same_plane(around.own, laser, rim.met, rim.hit,
                    rim.ray.origin + rim.hit.distance_m * rim.ray.direction)) {
      return true;
    }
  }
  return false;
}

// Towards the neighbour; of the highest and the lowest ring, that have none on one side, away from
// the opposite one.
void Beam::cast(const Neighbourhood& around, std::size_t laser, std::size_t side,
                Rim& rim) const noexcept {
  const Ray& middle = around.own.rays[laser];
  const Ray* towards = neighbour(around, laser, side);
  const double sign = towards != nullptr ? 1.0 : -1.0;
  if (towards == nullptr) towards = neighbour(around, laser, side ^ 1U);
  Vec3 aside = towards->direction - middle.direction;
  aside -= aside.dot(middle.direction) * middle.direction;
  aside *= sign * radius_ / aside.norm();
  rim.cast = true;
  rim.ray = middle;
  rim.ray.direction = (middle.direction + aside).normalized();
  rim.met = around.own.around->cast(laser, rim.ray, rim.hit);
}

}  // namespace convexcut::simulation
