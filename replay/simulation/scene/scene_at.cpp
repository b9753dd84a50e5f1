// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "replay/simulation/scene/four_boxes.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/scene/scene_data.hpp"

namespace convexcut::simulation {
namespace {

Bounds around(const Mover& mover, const PartPose* poses) noexcept {
  Bounds bounds;
  for (std::size_t i = 0; i < mover.parts.size(); ++i) {
    const Vec3 reach = Vec3::Constant(mover.parts[i].reach);
    bounds.add(poses[i].middle_world - reach);
    bounds.add(poses[i].middle_world + reach);
  }
  return bounds;
}

bool misses_sphere(const Ray& ray, const Vec3& middle, double radius) noexcept {
  const Vec3 to_middle = middle - ray.origin;
  const double along = to_middle.dot(ray.direction);
  return to_middle.squaredNorm() - along * along > radius * radius;
}

// As Geometry::cast, on one mover; the normal is the world's.
void cast_on_mover(const Mover& mover, const PartPose* poses, const Ray& ray, Hit& hit) noexcept {
  for (std::size_t i = 0; i < mover.parts.size(); ++i) {
    const MoverPart& part = mover.parts[i];
    const PartPose& pose = poses[i];
    if (misses_sphere(ray, pose.middle_world, part.reach)) continue;
    const Ray local{pose.part_from_world * (ray.origin - pose.world_from_part_offset),
                    pose.part_from_world * ray.direction, ray.min_distance_m, ray.max_distance_m};
    if (const Primitive* met = part.geometry.cast(local, hit)) {
      const Vec3 p = local.origin + hit.distance_m * local.direction;
      hit.normal = pose.part_from_world.transpose() * normal_at(met->shape, p);
    }
  }
}

}  // namespace

SceneAt::SceneAt(std::shared_ptr<const detail::SceneData> scene) : scene_(std::move(scene)) {
  std::size_t parts = 0;
  for (const Mover& mover : scene_->movers) parts += mover.parts.size();
  poses_.resize(parts);
  mover_boxes_.resize((scene_->movers.size() + 3) / 4, FourBoxes::nothing());
  first_pose_.reserve(scene_->movers.size());
  parts = 0;
  for (const Mover& mover : scene_->movers) {
    first_pose_.push_back(parts);
    parts += mover.parts.size();
  }
}

SceneAt::SceneAt(const SceneAt&) = default;
SceneAt::SceneAt(SceneAt&&) noexcept = default;
SceneAt& SceneAt::operator=(const SceneAt&) = default;
SceneAt& SceneAt::operator=(SceneAt&&) noexcept = default;
SceneAt::~SceneAt() = default;

void SceneAt::move_to(Duration since_start) noexcept {
  for (std::size_t i = 0; i < scene_->movers.size(); ++i) {
    PartPose* poses = poses_.data() + first_pose_[i];
    place_parts(scene_->movers[i], since_start, poses);
    mover_boxes_[i / 4].set(i % 4, around(scene_->movers[i], poses));
  }
}

bool SceneAt::cast(const Ray& ray, Hit& hit) const noexcept {
  hit = {};
  if (const Primitive* met = scene_->still.cast(ray, hit)) {
    hit.normal = normal_at(met->shape, ray.origin + hit.distance_m * ray.direction);
  }
  if (!mover_boxes_.empty()) {
    const BoxRay box_ray(ray);
    for (std::size_t four = 0; four < mover_boxes_.size(); ++four) {
      const float limit = BoxRay::limit_of(std::min(hit.distance_m, ray.max_distance_m));
      box_ray.meet(mover_boxes_[four], limit, [&](std::size_t lane, float /*enter*/) {
        const std::size_t mover = 4 * four + lane;
        cast_on_mover(scene_->movers[mover], poses_.data() + first_pose_[mover], ray, hit);
      });
    }
  }
  if (hit.surface == kNoSurface) return false;
  if (hit.normal.dot(ray.direction) > 0.0) hit.normal = -hit.normal;
  return true;
}

}  // namespace convexcut::simulation
