// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <utility>

#include "replay/simulation/scene/eight_boxes.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/scene/scene_data.hpp"
#include "replay/simulation/scene/shaft.hpp"

namespace convexcut::simulation {
namespace {

constexpr std::size_t kLanes = EightBoxes::kLanes;

// The numbers of things: of a primitive that never moves its index; of a mover's part, its index
// and this.
constexpr std::uint32_t kIsPart = std::uint32_t{1} << 31U;

Ray in_part(const PartPose& pose, const Ray& ray) noexcept {
  return {pose.part_from_world * (ray.origin - pose.origin_world),
          pose.part_from_world * ray.direction, ray.min_distance_m, ray.max_distance_m};
}

void cast_on_part(const Geometry& part, const Ray& ray_part, Nearest& nearest,
                  std::uint32_t number) noexcept {
  Nearest in_part(nearest.before_m());
  constexpr std::size_t kHandful = 4;
  if (part.primitives().size() <= kHandful) {
    part.cast_on_each(ray_part, in_part);
  } else {
    part.cast(ray_part, BoxRay(ray_part), in_part);
  }
  if (in_part.primitive() == nullptr) return;
  nearest.offer(in_part.distance_m(), *in_part.primitive(), number);
}

float limit_of(const Nearest& nearest) noexcept { return BoxRay::limit_of(nearest.distance_m()); }

}  // namespace

SceneAt::SceneAt(std::shared_ptr<const detail::SceneData> scene) : scene_(std::move(scene)) {
  Slot next;
  for (const Mover& mover : scene_->movers) {
    slots_.push_back(next);
    for (const MoverPart& part : mover.parts) parts_.push_back(&part);
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
  const BoxRay box_ray(ray);
  Nearest nearest(ray.max_distance_m);
  scene_->still.cast(ray, box_ray, nearest);
  for (std::size_t i = 0; i < mover_boxes_.size(); ++i) {
    box_ray.meet(mover_boxes_[i], limit_of(nearest), [&](std::size_t lane, float /*enter*/) {
      cast_on_mover(kLanes * i + lane, ray, box_ray, nearest);
    });
  }
  return settle(ray, nearest, hit);
}

bool SceneAt::cast(const Ray& ray, const InShaft& in_shaft, Hit& hit) const noexcept {
  Nearest nearest(ray.max_distance_m);
  if (in_shaft.size() == 1) {
    try_on(in_shaft.groups_.front().things.front(), ray, nearest);
  } else {
    const BoxRay box_ray(ray);
    float limit = limit_of(nearest);
    const std::size_t lanes = in_shaft.size() <= kLanes / 2 ? kLanes / 2 : kLanes;
    for (const InShaft::Group& group : in_shaft.groups_) {
      if (group.nearest > limit) break;
      const auto met = [&](std::size_t lane, float enter) {
        if (enter > limit) return;
        try_on(group.things[lane], ray, nearest);
        limit = limit_of(nearest);
      };
      box_ray.meet(group.boxes, limit, met, lanes);
    }
  }
  return settle(ray, nearest, hit);
}

void SceneAt::try_on(std::uint32_t thing, const Ray& ray, Nearest& nearest) const noexcept {
  if ((thing & kIsPart) == 0) {
    nearest.try_on(ray, scene_->still.primitives()[thing], thing);
  } else {
    const std::size_t part = thing & ~kIsPart;
    cast_on_part(parts_[part]->geometry, in_part(poses_[part], ray), nearest, thing);
  }
}

bool SceneAt::settle(const Ray& ray, const Nearest& nearest, Hit& hit) const noexcept {
  if (nearest.primitive() == nullptr) {
    hit = {};
    return false;
  }
  hit.distance_m = nearest.distance_m();
  hit.surface = nearest.primitive()->surface;
  const Shape& shape = nearest.primitive()->shape;
  if ((nearest.number() & kIsPart) == 0) {
    hit.normal = normal_at(shape, ray.origin + hit.distance_m * ray.direction);
  } else {
    const PartPose& pose = poses_[nearest.number() & ~kIsPart];
    const Ray local = in_part(pose, ray);
    hit.normal = pose.part_from_world.transpose() *
                 normal_at(shape, local.origin + hit.distance_m * local.direction);
  }
  if (hit.normal.dot(ray.direction) > 0.0) hit.normal = -hit.normal;
  return true;
}

void SceneAt::cast_on_mover(std::size_t index, const Ray& ray, const BoxRay& box_ray,
                            Nearest& nearest) const noexcept {
  const Slot& slot = slots_[index];
  const std::size_t parts = scene_->movers[index].parts.size();
  for (std::size_t first = 0; first < parts; first += kLanes) {
    const EightBoxes& boxes = part_boxes_[slot.boxes + first / kLanes];
    box_ray.meet(boxes, limit_of(nearest), [&](std::size_t lane, float /*enter*/) {
      try_on(kIsPart | static_cast<std::uint32_t>(slot.pose + first + lane), ray, nearest);
    });
  }
}

void SceneAt::gather(const Shaft& shaft, InShaft& out) const {
  const BoxShaft box_shaft(shaft);
  out.begin();
  const auto found = [&](std::size_t thing, float enter, const EightBoxes& boxes,
                         std::size_t lane) {
    out.add(static_cast<std::uint32_t>(thing), enter, boxes, lane);
  };
  scene_->still.for_each_in(box_shaft, found);
  for (std::size_t i = 0; i < mover_boxes_.size(); ++i) {
    box_shaft.meet(mover_boxes_[i], [&](std::size_t lane, float /*enter*/) {
      const std::size_t mover = kLanes * i + lane;
      const Slot& slot = slots_[mover];
      const std::size_t parts = scene_->movers[mover].parts.size();
      for (std::size_t first = 0; first < parts; first += kLanes) {
        const EightBoxes& boxes = part_boxes_[slot.boxes + first / kLanes];
        box_shaft.meet(boxes, [&](std::size_t part, float enter) {
          found(kIsPart | (slot.pose + first + part), enter, boxes, part);
        });
      }
    });
  }
  out.finish();
}

}  // namespace convexcut::simulation
