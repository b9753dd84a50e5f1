// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "replay/simulation/scene/shapes.hpp"

namespace convexcut::simulation {

Cylinder::Cylinder(Vec3 from, const Vec3& to, double radius, Ends ends) noexcept
    : from_(std::move(from)),
      axis_((to - from_).normalized()),
      length_((to - from_).norm()),
      radius_(radius),
      ends_(ends) {}

Cylinder Cylinder::part(const Vec3& zero, Radians from, Radians extent) const noexcept {
  Cylinder part = *this;
  const Vec3 start = (zero - zero.dot(axis_) * axis_).normalized();
  const double middle = from.value + extent.value / 2.0;
  part.middle_of_part_ = std::cos(middle) * start + std::sin(middle) * axis_.cross(start);
  part.cos_half_part_ = std::cos(extent.value / 2.0);
  part.ends_ = Ends::open;
  return part;
}

double Cylinder::meet(const Ray& ray, double nearest) const noexcept {
  const double mantle = meet_mantle(ray, nearest);
  if (ends_ == Ends::open) return mantle;
  return std::min(mantle, meet_ends(ray, nearest));
}

double Cylinder::meet_mantle(const Ray& ray, double nearest) const noexcept {
  const Vec3 to_base = from_ - ray.origin;
  const double climb = ray.direction.dot(axis_);
  const Vec3 across = ray.direction - climb * axis_;
  const double squared_speed = across.squaredNorm();
  if (squared_speed < 1e-20) return kNoHit;  // along the axis
  const Vec3 to_axis = to_base - to_base.dot(axis_) * axis_;
  // From the ray's point that is nearest to the axis: small numbers, so nothing cancels.
  const double middle = to_axis.dot(across) / squared_speed;
  const double squared = radius_ * radius_ - (to_axis - middle * across).squaredNorm();
  if (squared < 0.0) return kNoHit;
  const double reach = std::sqrt(squared / squared_speed);
  for (const double distance : {middle - reach, middle + reach}) {
    if (distance < ray.min_distance_m || distance >= nearest) continue;
    const Vec3 from_base = distance * ray.direction - to_base;
    const double height = from_base.dot(axis_);
    if (height < 0.0 || height > length_) continue;
    if (cos_half_part_ > -1.0) {
      if (from_base.dot(middle_of_part_) < cos_half_part_ * radius_) continue;
    }
    return distance;
  }
  return kNoHit;
}

double Cylinder::meet_ends(const Ray& ray, double nearest) const noexcept {
  const double climb = ray.direction.dot(axis_);
  if (climb == 0.0) return kNoHit;
  const Vec3 to_base = from_ - ray.origin;
  double best = kNoHit;
  for (const double height : {0.0, length_}) {
    const double distance = (to_base.dot(axis_) + height) / climb;
    if (distance < ray.min_distance_m || distance >= std::min(nearest, best)) continue;
    const Vec3 from_middle = distance * ray.direction - to_base - height * axis_;
    if (from_middle.squaredNorm() <= radius_ * radius_) best = distance;
  }
  return best;
}

Vec3 Cylinder::normal_at(const Vec3& p) const noexcept {
  const Vec3 from_base = p - from_;
  const double height = from_base.dot(axis_);
  const Vec3 outwards = from_base - height * axis_;
  const double from_mantle = std::abs(outwards.norm() - radius_);
  const double from_end = std::min(std::abs(height), std::abs(height - length_));
  if (ends_ == Ends::closed && from_end < from_mantle) return axis_;
  return outwards.normalized();
}

// How far the mantle reaches from its axis along a direction.
double Cylinder::reach(const Vec3& direction) const noexcept {
  const double ahead = direction.dot(middle_of_part_);
  const double aside = direction.dot(axis_.cross(middle_of_part_));
  const double most = std::sqrt(std::max(0.0, 1.0 - std::pow(direction.dot(axis_), 2)));
  if (cos_half_part_ <= -1.0 || ahead >= most * cos_half_part_) return radius_ * most;
  const double sin_half_part = std::sqrt(1.0 - cos_half_part_ * cos_half_part_);
  return radius_ * (ahead * cos_half_part_ + std::abs(aside) * sin_half_part);
}

Bounds Cylinder::bounds() const noexcept {
  Bounds bounds;
  const Vec3 up(reach(Vec3::UnitX()), reach(Vec3::UnitY()), reach(Vec3::UnitZ()));
  const Vec3 down(reach(-Vec3::UnitX()), reach(-Vec3::UnitY()), reach(-Vec3::UnitZ()));
  for (const Vec3& middle : {from_, Vec3(from_ + length_ * axis_)}) {
    bounds.add(middle + up);
    bounds.add(middle - down);
  }
  return bounds;
}

Cylinder Cylinder::placed(const RigidTransform& world_from_local) const noexcept {
  Cylinder moved = *this;
  moved.from_ = world_from_local * from_;
  moved.axis_ = world_from_local.rotation * axis_;
  moved.middle_of_part_ = world_from_local.rotation * middle_of_part_;
  return moved;
}

}  // namespace convexcut::simulation
