// SPDX-License-Identifier: Apache-2.0
//
// An HDL-32E in a scene: every laser is cast at its own time, with the rotor, the rig and all that
// moves where they are then.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/time.hpp"
#include "replay/simulation/lidar/beam.hpp"
#include "replay/simulation/lidar/column.hpp"
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
  static constexpr Duration kFiringPeriod = ColumnCaster::kFiringPeriod;

  // Throws std::invalid_argument when an option is out of its range.
  LidarSimulator(const Scene& scene, const RigMotion& motion, const LidarOptions& options,
                 std::uint64_t seed);

  void fire(std::uint64_t firing, SimulatedFiring& out);

  [[nodiscard]] std::int64_t firings_per_packet() const noexcept {
    return caster_.firings_per_packet();
  }
  // True time of a firing since the start.
  [[nodiscard]] Duration time_of(std::int64_t firing) const noexcept {
    return caster_.time_of(firing);
  }

 private:
  // What is drawn for a shot whatever comes of it.
  struct Chance {
    bool lost = false;
    bool ghost = false;
    double ghost_place = 0.0;  // 0 … 1
    double speckle = 0.0;      // of the intensity
  };
  // The pulses of a shot that a receiver tells apart.
  struct Seen {
    const Echo* strongest = nullptr;
    const Echo* second = nullptr;
    const Echo* last = nullptr;
  };

  // Edges that run along the horizon stay under a beam for many firings: they are looked for at
  // every third one.
  static constexpr std::int64_t kFiringsPerLook = 3;
  void look_below_and_above(std::int64_t firing);

  [[nodiscard]] Chance draw(Random& random) const noexcept;
  // The next pulse of a shot, the nearest first.
  void listen(const Echo& pulse, double probability, Random& random, Seen& seen) const noexcept;
  [[nodiscard]] SimulatedReturn returned(const Echo& echo, const Chance& chance,
                                         Random& random) const noexcept;

  LidarOptions options_;
  RandomStream random_;
  ColumnCaster caster_;
  Optics optics_;
  Beam beam_;
  std::int64_t looked_at_ = Column::kUnknown;
  Beam::UprightSides upright_{};  // as of that firing
  PlainEchoes plain_;             // of the firing
  Echoes echoes_;
};

}  // namespace convexcut::simulation
