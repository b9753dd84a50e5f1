// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "replay/simulation/scene/geometry.hpp"
#include "replay/simulation/scene/movers.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation::detail {

struct SceneData {
  std::string name;
  std::string description;
  std::vector<SurfaceInfo> surfaces;
  RigPlan rig;
  Geometry still;  // what never moves, in the world
  std::vector<Mover> movers;
};

}  // namespace convexcut::simulation::detail
