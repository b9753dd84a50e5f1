// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace convexcut::sim {
namespace {

// A vector of level in the axes of something turned by yaw about z.
Vec3 turned(const Vec3& v, double cos_yaw, double sin_yaw) noexcept {
  return {cos_yaw * v.x() + sin_yaw * v.y(), -sin_yaw * v.x() + cos_yaw * v.y(), v.z()};
}

}  // namespace

Box::Box(Vec3 centre, const Vec3& size, Degrees yaw, Surface surface) noexcept
    : centre_(std::move(centre)),
      half_size_(size / 2.0),
      cos_yaw_(std::cos(yaw.to_radians().value)),
      sin_yaw_(std::sin(yaw.to_radians().value)),
      surface_(surface) {}

// The slab method: a ray is inside the box while it is between the planes of all three axes.
// Division by a zero component gives infinities, which compare as they should, or, on the very
// plane of a side, no number, which compares as false and leaves the others to decide.
void Box::meet(const Ray& ray, Hit& nearest) const noexcept {
  const Vec3 origin = turned(ray.origin - centre_, cos_yaw_, sin_yaw_);
  const Vec3 direction = turned(ray.direction, cos_yaw_, sin_yaw_);
  double enters = 0.0;
  double leaves = nearest.range_m;
  Eigen::Index face = -1;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double first = (-half_size_[axis] - origin[axis]) / direction[axis];
    double second = (half_size_[axis] - origin[axis]) / direction[axis];
    if (first > second) std::swap(first, second);
    if (first > enters) {
      enters = first;
      face = axis;
    }
    leaves = std::min(leaves, second);
    if (enters >= leaves) return;
  }
  if (face < 0) return;  // the ray starts inside
  nearest = {enters, std::abs(direction[face]), surface_};
}

void Cylinder::meet(const Ray& ray, Hit& nearest) const noexcept {
  const Vec3 to_origin = ray.origin - foot_;
  const double a = ray.direction.x() * ray.direction.x() + ray.direction.y() * ray.direction.y();
  const double half_b = to_origin.x() * ray.direction.x() + to_origin.y() * ray.direction.y();
  const double c =
      to_origin.x() * to_origin.x() + to_origin.y() * to_origin.y() - radius_ * radius_;
  const double discriminant = half_b * half_b - a * c;
  if (discriminant < 0.0) return;
  // The mantle, where it is entered.
  const double mantle = (-half_b - std::sqrt(discriminant)) / a;
  const double mantle_z = to_origin.z() + mantle * ray.direction.z();
  if (mantle > 0.0 && mantle < nearest.range_m && mantle_z >= 0.0 && mantle_z <= height_) {
    const double outward_x = (to_origin.x() + mantle * ray.direction.x()) / radius_;
    const double outward_y = (to_origin.y() + mantle * ray.direction.y()) / radius_;
    const double cosine = std::abs(outward_x * ray.direction.x() + outward_y * ray.direction.y());
    nearest = {mantle, cosine, surface_};
    return;
  }
  // The end that faces the ray.
  const double end_z = ray.direction.z() < 0.0 ? height_ : 0.0;
  const double end = (end_z - to_origin.z()) / ray.direction.z();
  if (!(end > 0.0 && end < nearest.range_m)) return;
  const double x = to_origin.x() + end * ray.direction.x();
  const double y = to_origin.y() + end * ray.direction.y();
  if (x * x + y * y > radius_ * radius_) return;
  nearest = {end, std::abs(ray.direction.z()), surface_};
}

Hit RoomShell::meet(const Ray& ray) const noexcept {
  Hit hit;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0.0) continue;  // parallel to both sides
    const bool upwards = ray.direction[axis] > 0.0;
    const double side = upwards ? high_[axis] : low_[axis];
    const double range = (side - ray.origin[axis]) / ray.direction[axis];
    if (range >= hit.range_m) continue;
    Surface surface = Surface::wall;
    if (axis == 2) surface = upwards ? Surface::ceiling : Surface::floor;
    hit = {range, std::abs(ray.direction[axis]), surface};
  }
  return hit;
}

}  // namespace convexcut::sim
