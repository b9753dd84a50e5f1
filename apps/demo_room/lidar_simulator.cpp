// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/lidar_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace convexcut::sim {
namespace {

constexpr double kDistanceUnit = 0.002;  // m
constexpr double kMinRange = 0.05;       // m; the sensor is blind below
constexpr double kMaxRange = 100.0;

// Diffuse reflectivity in percent.
double reflectivity(Surface surface) noexcept {
  switch (surface) {
    case Surface::wall:
      return 62.0;
    case Surface::floor:
      return 24.0;
    case Surface::ceiling:
      return 74.0;
    case Surface::pillar:
      return 52.0;
    case Surface::furniture:
      return 36.0;
    case Surface::person:
      return 30.0;
  }
  return 0.0;
}

}  // namespace

LidarSimulator::LidarSimulator(Scene scene, const RigMotion& motion, const LidarOptions& options,
                               Random random)
    : scene_(std::move(scene)), motion_(motion), options_(options), random_(std::move(random)) {
  const velodyne::Model& model = velodyne::model_of(velodyne::ModelId::hdl32e);
  for (std::size_t laser = 0; laser < elevation_.size(); ++laser) {
    const double angle = Degrees{model.elevation_mdeg[laser] * 1e-3}.to_radians().value;
    elevation_[laser] = {std::cos(angle), std::sin(angle)};
  }
}

Azimuth LidarSimulator::rotor(Duration since_start) const noexcept {
  constexpr double kMicrodegreesPerTurn = Azimuth::kFullTurn;
  const double turns = options_.rotor_hz * std::chrono::duration<double>(since_start).count();
  return Azimuth::from_microdegrees(Azimuth::from_degrees(options_.start_azimuth).microdegrees() +
                                    std::llround(turns * kMicrodegreesPerTurn));
}

void LidarSimulator::fill(std::uint64_t packet, std::array<DataBlock, layout::kBlocks>& blocks) {
  Duration firing = first_firing(packet);
  for (DataBlock& block : blocks) {
    fire(firing, block);
    firing += kFiringPeriod;
  }
}

void LidarSimulator::fire(Duration since_start, DataBlock& block) {
  const velodyne::Model& model = velodyne::model_of(velodyne::ModelId::hdl32e);
  scene_.move_to(since_start);
  block.azimuth = rotor(since_start);
  for (std::size_t laser = 0; laser < block.returns.size(); ++laser) {
    const Duration fired = since_start + Duration{model.laser_time_ns(laser)};
    const double azimuth = rotor(fired).radians().value;
    const auto [cosine, sine] = elevation_[laser];
    // REP-103: x at azimuth 0, y to the left; the azimuth grows clockwise.
    const Vec3 beam_lidar(cosine * std::cos(azimuth), -cosine * std::sin(azimuth), sine);
    const Ray ray{Vec3::Zero(), motion_.q_level_from_rig(fired) * beam_lidar};
    block.returns[laser] = measure(scene_.cast(ray));
  }
}

LaserReturn LidarSimulator::measure(const Hit& hit) {
  // Drawn whatever comes of it, so that the options do not shift the sequence.
  const bool lost = random_.uniform() < options_.dropout;
  const double range = hit.range_m + options_.noise_m * random_.gaussian();
  const double speckle = random_.uniform(-4.0, 4.0);
  if (lost || !(range >= kMinRange && range <= kMaxRange)) return {};
  const double brightness = reflectivity(hit.surface) * (0.3 + 0.7 * hit.cos_incidence) + speckle;
  return {static_cast<std::uint16_t>(std::lround(range / kDistanceUnit)),
          static_cast<std::uint8_t>(std::clamp(std::lround(brightness), 1L, 100L))};
}

}  // namespace convexcut::sim
