// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "core/geometry.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation::test {

// An empty room whose walls, floor and ceiling reflect alike; the lidar stands 1.2 m above the
// floor, 3 m from the west wall (x = 0) and 2 m from the south wall (y = 0).
inline constexpr const char* kEmptyRoom = R"(
description = "an empty room"
[rig]
position = [3.0, 2.0, 1.2]
[[room]]
name = "room"
min = [0, 0, 0]
max = [8, 6, 3]
reflectivity = 0.6
)";
inline const Vec3 kRoom(8.0, 6.0, 3.0);

[[nodiscard]] inline Scene scene_of(const std::string& toml) {
  return Scene::parse(toml, "test.toml");
}
[[nodiscard]] inline Scene empty_room() { return scene_of(kEmptyRoom); }

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
