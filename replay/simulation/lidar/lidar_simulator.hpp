// SPDX-License-Identifier: Apache-2.0
//
// An HDL-32E in a scene: every laser is cast at its own time, with the rotor, the rig and all that
// moves where they are then.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>

#include "core/angle.hpp"
#include "core/time.hpp"
#include "drivers/velodyne/sin_cos.hpp"
#include "replay/simulation/lidar/echoes.hpp"
#include "replay/simulation/lidar/lidar_options.hpp"
#include "replay/simulation/lidar/simulated_firing.hpp"
#include "replay/simulation/random.hpp"
#include "replay/simulation/rig/rig_motion.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {

// A firing is the same whatever was asked for before it; asking in order is faster. One thread.
class LidarSimulator {
 public:
  // By the sensor's clock.
  static constexpr Duration kFiringPeriod{46'080};
  static constexpr std::size_t kLasers = SimulatedFiring::kLasers;

  // Throws std::invalid_argument when an option is out of its range.
  LidarSimulator(const Scene& scene, const RigMotion& motion, const LidarOptions& options,
                 std::uint64_t seed);

  void fire(std::uint64_t firing, SimulatedFiring& out);

  // How many firings are in one packet.
  [[nodiscard]] std::int64_t firings_per_packet() const noexcept { return options_.dual ? 6 : 12; }
  // True time of a firing since the start.
  [[nodiscard]] Duration time_of(std::int64_t firing) const noexcept;

 private:
  // The middle rays of a firing's beams, and what they meet.
  struct Column {
    bool known = false;
    std::int64_t firing = 0;
    std::array<Ray, kLasers> rays;
    std::array<Hit, kLasers> hits;
    std::bitset<kLasers> met;
  };
  struct Place {
    Vec3 position_world = Vec3::Zero();
    Eigen::Matrix3d world_from_lidar = Eigen::Matrix3d::Identity();
  };

  [[nodiscard]] Azimuth rotor(std::int64_t firing) const noexcept;
  [[nodiscard]] std::int64_t azimuth_step(std::int64_t firing) const noexcept;
  [[nodiscard]] Place place(std::int64_t firing);
  const Column& column(std::int64_t firing);
  void aim(std::int64_t firing, Column& column);
  void measure(const Column& column, std::size_t laser, Random& random, SimulatedFiring& out);
  void gather_echoes(const Column& column, std::size_t laser);
  [[nodiscard]] bool add_edge(const Column& column, std::size_t laser);
  [[nodiscard]] SimulatedReturn returned(const Echo& echo, bool ghost, double ghost_share,
                                         double speckle, Random& random) const noexcept;

  LidarOptions options_;
  std::uint64_t seed_;
  RigMotion motion_;
  Optics optics_;
  SceneAt rays_scene_;   // for the middle rays, a firing ahead of
  SceneAt edges_scene_;  // for the edges of beams
  std::int64_t edges_firing_ = -1;
  struct Elevation {
    double cos, sin;
  };
  std::array<Elevation, kLasers> elevation_{};     // in firing order
  std::array<std::int64_t, kLasers> share_q32_{};  // of the firing period that has passed
  std::array<std::size_t, kLasers> laser_of_ring_{};
  std::array<std::size_t, kLasers> ring_of_laser_{};
  std::array<Column, 3> columns_;
  std::int64_t placed_firing_ = -2;
  Place placed_;
  Echoes echoes_;
};

}  // namespace convexcut::simulation
