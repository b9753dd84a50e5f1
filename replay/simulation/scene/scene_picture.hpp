// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/time.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {

// A picture of the scene at an instant, to look at: from above (cut open below the ceiling), and
// all round from the rig's start. Colours are labels. PNG; throws std::runtime_error of one line.
void write_scene_picture(const Scene& scene, Duration since_start,
                         const std::filesystem::path& file);

}  // namespace convexcut::simulation
