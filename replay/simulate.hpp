// SPDX-License-Identifier: Apache-2.0
//
// `convexcut simulate`: a recording of a room that does not exist, with the truth of every return.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/simulation.hpp"

namespace convexcut::replay {

struct SimulateOptions {
  std::string scene;  // a shipped one's name, or a file
  simulation::SceneOptions scene_options{};
  simulation::SimulationOptions simulation{};
  // What depends on the scene: where the rig stands or travels.
  std::function<void(const simulation::Scene&, simulation::RigOptions&)> place_rig;
  std::filesystem::path out;
  std::filesystem::path picture;  // empty: none
  bool json = false;
};

// Prints a summary on stdout. The folder gets its name when all of it is there. Throws
// config::ConfigError (the scene: one line an error), command_line::UsageError and
// std::runtime_error, both of one line.
void simulate(const SimulateOptions& options);

}  // namespace convexcut::replay
