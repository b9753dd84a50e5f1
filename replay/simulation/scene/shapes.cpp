// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace convexcut::simulation {
namespace {

// Shapes that share an edge leave no gap: what is this near to an edge (metres, or this part of an
// edge's length) belongs to the shape.
constexpr double kEdgeTolerance = 1e-9;
constexpr double kNearlyParallel = 1e-14;

bool within(const Ray& ray, double distance, double nearest) noexcept {
  return distance >= ray.min_distance_m && distance < nearest;
}

}  // namespace

Flat::Flat(Vec3 corner, Vec3 edge_u, Vec3 edge_v, Form form) noexcept
    : corner_(std::move(corner)),
      edge_u_(std::move(edge_u)),
      edge_v_(std::move(edge_v)),
      normal_(edge_u_.cross(edge_v_).normalized()),
      form_(form) {}

// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
double Flat::meet(const Ray& ray, double nearest) const noexcept {
  if (std::abs(ray.direction.dot(normal_)) < kNearlyParallel) return kNoHit;
  const Vec3 across = ray.direction.cross(edge_v_);
  const double determinant = edge_u_.dot(across);
  const double scale = 1.0 / determinant;
  const Vec3 from_corner = ray.origin - corner_;
  const double u = from_corner.dot(across) * scale;
  if (u < -kEdgeTolerance || u > 1.0 + kEdgeTolerance) return kNoHit;
  const Vec3 turned = from_corner.cross(edge_u_);
  const double v = ray.direction.dot(turned) * scale;
  const double last = form_ == Form::triangle ? 1.0 - u : 1.0;
  if (v < -kEdgeTolerance || v > last + kEdgeTolerance) return kNoHit;
  const double distance = edge_v_.dot(turned) * scale;
  if (!within(ray, distance, nearest)) return kNoHit;
  return distance;
}

Vec3 Flat::normal_at(const Vec3& /*p*/) const noexcept { return normal_; }

Bounds Flat::bounds() const noexcept {
  Bounds bounds;
  bounds.add(corner_);
  bounds.add(corner_ + edge_u_);
  bounds.add(corner_ + edge_v_);
  if (form_ == Form::parallelogram) bounds.add(corner_ + edge_u_ + edge_v_);
  return bounds;
}

Flat Flat::placed(const RigidTransform& world_from_local) const noexcept {
  return {world_from_local * corner_, world_from_local.rotation * edge_u_,
          world_from_local.rotation * edge_v_, form_};
}

Block::Block(const RigidTransform& world_from_block, Vec3 half_size) noexcept
    : block_from_world_(world_from_block.rotation.conjugate().toRotationMatrix()),
      centre_(world_from_block.translation),
      half_size_(std::move(half_size)),
      is_upright_(block_from_world_ == Eigen::Matrix3d::Identity()) {}

double Block::meet(const Ray& ray, double nearest) const noexcept {
  const Vec3 origin = turned(ray.origin - centre_);
  const Vec3 direction = turned(ray.direction);
  double enter = -kNoHit;
  double leave = kNoHit;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double half = half_size_[axis];
    if (direction[axis] == 0.0) {
      if (std::abs(origin[axis]) > half) return kNoHit;
      continue;
    }
    const double scale = 1.0 / direction[axis];
    const double middle = -origin[axis] * scale;
    const double reach = half * std::abs(scale);
    enter = std::max(enter, middle - reach);
    leave = std::min(leave, middle + reach);
  }
  if (enter > leave) return kNoHit;
  if (within(ray, enter, nearest)) return enter;
  if (within(ray, leave, nearest)) return leave;
  return kNoHit;
}

Vec3 Block::normal_at(const Vec3& p) const noexcept {
  const Vec3 local = turned(p - centre_);
  Eigen::Index axis = 0;
  (local.cwiseAbs() - half_size_).maxCoeff(&axis);
  return block_from_world_.row(axis).transpose();
}

Bounds Block::bounds() const noexcept {
  const Vec3 reach = block_from_world_.cwiseAbs().transpose() * half_size_;
  return {centre_ - reach, centre_ + reach};
}

Block Block::placed(const RigidTransform& world_from_local) const noexcept {
  const Quaternion own(Eigen::Matrix3d(block_from_world_.transpose()));
  return {world_from_local * RigidTransform{own, centre_}, half_size_};
}

Sphere::Sphere(Vec3 centre, double radius) noexcept : centre_(std::move(centre)), radius_(radius) {}

double Sphere::meet(const Ray& ray, double nearest) const noexcept {
  const Vec3 to_centre = centre_ - ray.origin;
  // From the ray's point that is nearest to the centre: small numbers, so nothing cancels.
  const double middle = to_centre.dot(ray.direction);
  const double squared = radius_ * radius_ - (to_centre - middle * ray.direction).squaredNorm();
  if (squared < 0.0) return kNoHit;
  const double reach = std::sqrt(squared);
  if (within(ray, middle - reach, nearest)) return middle - reach;
  if (within(ray, middle + reach, nearest)) return middle + reach;
  return kNoHit;
}

Vec3 Sphere::normal_at(const Vec3& p) const noexcept { return (p - centre_).normalized(); }

Bounds Sphere::bounds() const noexcept {
  return {centre_ - Vec3::Constant(radius_), centre_ + Vec3::Constant(radius_)};
}

Sphere Sphere::placed(const RigidTransform& world_from_local) const noexcept {
  return {world_from_local * centre_, radius_};
}

}  // namespace convexcut::simulation
