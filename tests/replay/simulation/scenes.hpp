// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation::test {

// An empty room, 8 × 6 × 3 m, whose walls, floor and ceiling reflect alike; the lidar stands
// 1.2 m above the floor, 3 m from the west wall (x = 0) and 2 m from the south wall (y = 0).
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

[[nodiscard]] inline Scene scene_of(const std::string& toml) {
  return Scene::parse(toml, "test.toml");
}
[[nodiscard]] inline Scene empty_room() { return scene_of(kEmptyRoom); }

}  // namespace convexcut::simulation::test
