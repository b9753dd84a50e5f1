// SPDX-License-Identifier: Apache-2.0
//
// The scene during a few firings in a row, and what each laser may meet in it.
#pragma once

#include <array>
#include <cstddef>

#include "replay/simulation/lidar/simulated_firing.hpp"
#include "replay/simulation/scene/ray.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/scene/shaft.hpp"

namespace convexcut::simulation {

class Surroundings {
 public:
  static constexpr std::size_t kLasers = SimulatedFiring::kLasers;
  // Movers are placed anew every eight firings: 369 µs, in which somebody who walks goes 0.5 mm.
  static constexpr std::size_t kFirings = 8;
  using Rays = std::array<std::array<Ray, kLasers>, kFirings>;

  // `beam_radius`: of a beam at 1 m.
  Surroundings(const Scene& scene, double beam_radius);

  // Moves the scene, and takes the rays of the lasers' middles in its firings.
  void move_to(Duration since_start, const Rays& rays);

  // As SceneAt::cast; for the laser's beam, in any of the firings.
  bool cast(std::size_t laser, const Ray& ray, Hit& hit) const noexcept {
    return scene_.cast(ray, in_shafts_[shaft_[laser]], hit);
  }
  // For any ray.
  bool cast(const Ray& ray, Hit& hit) const noexcept { return scene_.cast(ray, hit); }

 private:
  SceneAt scene_;
  double beam_radius_;
  // One for so many rings that are neighbours: with more of them rays are tried on more, with fewer
  // more is gathered.
  static constexpr std::size_t kRings = 4;
  std::array<std::size_t, kLasers> shaft_{};
  std::array<InShaft, kLasers / kRings> in_shafts_;
};

}  // namespace convexcut::simulation
