// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "replay/simulation/scene/eight_boxes.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/scene/scene_data.hpp"

namespace convexcut::simulation {
namespace {

constexpr std::size_t kLanes = EightBoxes::kLanes;

// As Geometry::cast; the normal is the world's.
void cast_on_part(const MoverPart& part, const PartPose& pose, const Ray& ray, Hit& hit) noexcept {
  const Ray local{pose.part_from_world * (ray.origin - pose.origin_world),
                  pose.part_from_world * ray.direction, ray.min_distance_m, ray.max_distance_m};
  constexpr std::size_t kHandful = 4;
  const bool is_small = part.geometry.primitives().size() <= kHandful;
  const Primitive* met = is_small ? part.geometry.cast_on_each(local, hit)
                                  : part.geometry.cast(local, BoxRay(local), hit);
  if (met == nullptr) return;
  const Vec3 p = local.origin + hit.distance_m * local.direction;
  hit.normal = pose.part_from_world.transpose() * normal_at(met->shape, p);
}

float limit_of(const Ray& ray, const Hit& hit) noexcept {
  return BoxRay::limit_of(std::min(hit.distance_m, ray.max_distance_m));
}

}  // namespace

SceneAt::SceneAt(std::shared_ptr<const detail::SceneData> scene) : scene_(std::move(scene)) {
  Slot next;
  for (const Mover& mover : scene_->movers) {
    slots_.push_back(next);
    next.pose += mover.parts.size();
    next.boxes += (mover.parts.size() + kLanes - 1) / kLanes;
  }
  poses_.resize(next.pose);
  part_boxes_.resize(next.boxes, EightBoxes::nothing());
  mover_boxes_.resize((slots_.size() + kLanes - 1) / kLanes, EightBoxes::nothing());
}

SceneAt::SceneAt(const SceneAt&) = default;
SceneAt::SceneAt(SceneAt&&) noexcept = default;
SceneAt& SceneAt::operator=(const SceneAt&) = default;
SceneAt& SceneAt::operator=(SceneAt&&) noexcept = default;
SceneAt::~SceneAt() = default;

void SceneAt::move_to(Duration since_start) noexcept {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const Mover& mover = scene_->movers[i];
    PartPose* poses = poses_.data() + slots_[i].pose;
    place_parts(mover, since_start, poses);
    Bounds whole;
    for (std::size_t part = 0; part < mover.parts.size(); ++part) {
      const Bounds around = poses[part].around(mover.parts[part].geometry.bounds());
      part_boxes_[slots_[i].boxes + part / kLanes].set(part % kLanes, around);
      whole.add(around);
    }
    mover_boxes_[i / kLanes].set(i % kLanes, whole);
  }
}

bool SceneAt::cast(const Ray& ray, Hit& hit) const noexcept {
  hit = {};
  const BoxRay box_ray(ray);
  if (const Primitive* met = scene_->still.cast(ray, box_ray, hit)) {
    hit.normal = normal_at(met->shape, ray.origin + hit.distance_m * ray.direction);
  }
  for (std::size_t i = 0; i < mover_boxes_.size(); ++i) {
    box_ray.meet(mover_boxes_[i], limit_of(ray, hit), [&](std::size_t lane, float /*enter*/) {
      cast_on_mover(kLanes * i + lane, ray, box_ray, hit);
    });
  }
  if (hit.surface == kNoSurface) return false;
  if (hit.normal.dot(ray.direction) > 0.0) hit.normal = -hit.normal;
  return true;
}

void SceneAt::cast_on_mover(std::size_t index, const Ray& ray, const BoxRay& box_ray,
                            Hit& hit) const noexcept {
  const Mover& mover = scene_->movers[index];
  const Slot& slot = slots_[index];
  for (std::size_t first = 0; first < mover.parts.size(); first += kLanes) {
    const EightBoxes& boxes = part_boxes_[slot.boxes + first / kLanes];
    box_ray.meet(boxes, limit_of(ray, hit), [&](std::size_t lane, float /*enter*/) {
      cast_on_part(mover.parts[first + lane], poses_[slot.pose + first + lane], ray, hit);
    });
  }
}

}  // namespace convexcut::simulation
