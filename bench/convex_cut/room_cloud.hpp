// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/cloud.hpp"

namespace convexcut::bench {

struct RoomCloud {
  std::vector<float> x, y, z;
  std::vector<std::uint16_t> side;  // of which box the point is: 6 to a box, the room's first
  [[nodiscard]] CloudView view() const { return {x, y, z}; }
};

// One HDL-32E revolution of 32 × `firings` returns in a furnished room of 9 × 7 × 2.8 m, in firing
// order, sensor 1.1 m above the floor and tilted by `tilt_deg` before levelling, range noise 2 cm
// (1 σ). Deterministic.
[[nodiscard]] RoomCloud room_cloud(std::size_t firings, double tilt_deg);

}  // namespace convexcut::bench
