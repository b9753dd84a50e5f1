// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/scene.hpp"

#include <stdexcept>
#include <utility>

namespace convexcut::sim {

Scene::Scene(RoomShell room) : room_(std::move(room)) {
  if (!room_.contains(Vec3::Zero())) throw std::invalid_argument("the lidar is outside the room");
}

void Scene::move_to(Duration since_start) noexcept {
  for (Walker& walker : walkers_) walker.move_to(since_start);
}

Hit Scene::cast(const Ray& ray) const noexcept {
  Hit nearest = room_.meet(ray);
  for (const Thing& thing : things_) thing.meet(ray, nearest);
  for (const Walker& walker : walkers_) walker.meet(ray, nearest);
  return nearest;
}

}  // namespace convexcut::sim
