// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry.hpp"
#include "core/time.hpp"

namespace convexcut {

// Where the lidar was at an instant, by whatever localises it. Frame world stands still and has z
// up.
struct PoseSample {
  HostTime stamp{};
  Vec3 position_world = Vec3::Zero();  // metres
  Quaternion q_world_from_lidar = Quaternion::Identity();
};

}  // namespace convexcut
