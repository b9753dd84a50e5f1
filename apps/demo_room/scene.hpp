// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "apps/demo_room/shapes.hpp"
#include "apps/demo_room/thing.hpp"
#include "apps/demo_room/walker.hpp"
#include "core/time.hpp"

namespace convexcut::sim {

// All that a lidar can meet. Frame level: the origin is where the lidar stands.
class Scene {
 public:
  // Throws std::invalid_argument when the lidar is outside the room.
  explicit Scene(RoomShell room);

  void add(Thing thing) { things_.push_back(std::move(thing)); }
  void add(Walker walker) { walkers_.push_back(std::move(walker)); }

  // Puts everybody where they are then.
  void move_to(Duration since_start) noexcept;
  // What a ray from inside the room meets first. There always is something.
  [[nodiscard]] Hit cast(const Ray& ray) const noexcept;

 private:
  RoomShell room_;
  std::vector<Thing> things_;
  std::vector<Walker> walkers_;
};

enum class Furnishing { empty, furnished };

// The demonstration room, 9 × 7 × 2.7 m, with the lidar 1.2 m above its floor; furnished: a pillar,
// desks, chairs, bookcases and two people walking.
[[nodiscard]] Scene demo_room(Furnishing furnishing);

}  // namespace convexcut::sim
