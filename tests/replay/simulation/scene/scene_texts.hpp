// SPDX-License-Identifier: Apache-2.0
//
// Scenes of a few lines, the mistakes in them, and what a ray meets there.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation::test {

[[nodiscard]] inline Scene parse(const std::string& text, const SceneOptions& options = {}) {
  return Scene::parse(text + "\n[rig]\nposition = [0, 0, 1]\n", "test.toml", options);
}

// The lines of the error that a scene gives; none when it succeeds.
[[nodiscard]] inline std::vector<std::string> errors_of(const std::string& text,
                                                        const SceneOptions& options = {}) {
  std::vector<std::string> lines;
  try {
    static_cast<void>(parse(text, options));
  } catch (const SceneError& error) {
    std::istringstream all(error.what());
    for (std::string line; std::getline(all, line);) lines.push_back(line);
  }
  return lines;
}

struct Seen {
  std::string surface;
  double distance_m = 0.0;
};

[[nodiscard]] inline Seen look(const Scene& scene, const Vec3& from, const Vec3& direction,
                               double least = 0.0) {
  Hit hit;
  if (!scene.at(Duration{}).cast({from, direction.normalized(), least}, hit)) return {"nothing"};
  return {scene.surfaces()[hit.surface].name, hit.distance_m};
}

[[nodiscard]] inline const SurfaceInfo& surface(const Scene& scene, const std::string& name) {
  for (const SurfaceInfo& each : scene.surfaces()) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(name);
}

}  // namespace convexcut::simulation::test
