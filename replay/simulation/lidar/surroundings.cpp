// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/lidar/surroundings.hpp"

#include "drivers/velodyne/model.hpp"

namespace convexcut::simulation {

Surroundings::Surroundings(const Scene& scene, double beam_radius)
    : scene_(scene.at(Duration{0})), beam_radius_(beam_radius) {
  const velodyne::Model& model = velodyne::model_of(velodyne::ModelId::hdl32e);
  for (std::size_t laser = 0; laser < kLasers; ++laser) {
    shaft_[laser] = std::size_t{model.ring[laser]} / kRings;
  }
}

void Surroundings::move_to(Duration since_start, const Rays& rays) {
  scene_.move_to(since_start);
  std::array<Shaft, kLasers / kRings> shafts;
  for (std::size_t laser = 0; laser < kLasers; ++laser) {
    Shaft& shaft = shafts[shaft_[laser]];
    for (const auto& firing : rays) shaft.add(firing[laser]);
  }
  for (std::size_t i = 0; i < shafts.size(); ++i) {
    shafts[i].widen(1.001 * beam_radius_ + 1e-6);
    scene_.gather(shafts[i], in_shafts_[i]);
  }
}

}  // namespace convexcut::simulation
