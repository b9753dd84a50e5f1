// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "core/geometry.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation::test {

// One room from the world's origin to `size`, whose walls, floor and ceiling reflect alike; more
// may be added. The lidar stands in it upright, its x axis along the world's.
[[nodiscard]] inline std::string room_of(const Vec3& size, const Vec3& lidar, double reflectivity) {
  const auto text_of = [](const Vec3& v) {
    return "[" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " +
           std::to_string(v.z()) + "]\n";
  };
  return "[rig]\nposition = " + text_of(lidar) +
         "[[room]]\nname = \"room\"\nmin = [0, 0, 0]\nmax = " + text_of(size) +
         "reflectivity = " + std::to_string(reflectivity) + "\n";
}

// The lidar stands 1.2 m above the floor, 3 m from the west wall (x = 0) and 2 m from the south
// wall (y = 0).
inline const Vec3 kRoom(8.0, 6.0, 3.0);
inline const Vec3 kLidar(3.0, 2.0, 1.2);
[[nodiscard]] inline std::string empty_room_text() { return room_of(kRoom, kLidar, 0.6); }

[[nodiscard]] inline Scene scene_of(const std::string& toml) {
  return Scene::parse(toml, "test.toml");
}
[[nodiscard]] inline Scene empty_room() { return scene_of(empty_room_text()); }

// From a point inside a box along a direction to its side.
[[nodiscard]] inline double to_side(const Vec3& from, const Vec3& direction, const Vec3& low,
                                    const Vec3& high) {
  double range = HUGE_VAL;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) continue;
    const double side = direction[axis] > 0 ? high[axis] : low[axis];
    range = std::min(range, (side - from[axis]) / direction[axis]);
  }
  return range;
}

}  // namespace convexcut::simulation::test
