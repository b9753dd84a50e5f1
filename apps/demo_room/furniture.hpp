// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/demo_room/thing.hpp"

namespace convexcut::sim {

// Where a piece of furniture stands and which way it faces.
struct Place {
  Vec3 floor;  // the middle of its footprint
  Degrees yaw{0.0};
};

[[nodiscard]] Thing make_desk(const Place& place);         // 1.6 × 0.8 × 0.74 m, with a screen
[[nodiscard]] Thing make_chair(const Place& place);        // back at −y of its own axes
[[nodiscard]] Thing make_bookcase(const Place& place);     // 0.9 × 0.35 × 2.0 m, back at +y
[[nodiscard]] Thing make_cabinet(const Place& place);      // 1.6 × 0.5 × 0.9 m
[[nodiscard]] Thing make_round_table(const Place& place);  // ⌀ 1 m
[[nodiscard]] Thing make_floor_lamp(const Place& place);   // 1.7 m high
[[nodiscard]] Thing make_pillar(const Place& place, double height_m);  // 0.4 × 0.4 m

}  // namespace convexcut::sim
