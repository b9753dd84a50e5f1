// SPDX-License-Identifier: Apache-2.0
//
// An HDL-32E in a scene: every laser is cast at its own time, with the rotor and the rig where they
// are then.
#pragma once

#include <array>
#include <cstdint>

#include "apps/demo_room/rig_motion.hpp"
#include "apps/demo_room/scene.hpp"
#include "core/angle.hpp"
#include "core/time.hpp"
#include "drivers/velodyne/model.hpp"
#include "replay/simulation/random.hpp"
#include "replay/simulation/wire/hdl32e_packets.hpp"

namespace convexcut::sim {

namespace layout = velodyne::wire_layout;
using simulation::DataBlock;
using simulation::LaserReturn;
using simulation::Random;

struct LidarOptions {
  double rotor_hz = 10.0;
  double noise_m = 0.02;         // standard deviation of a range
  double dropout = 0.03;         // share of the returns that are lost
  Degrees start_azimuth{215.0};  // of the first firing: the first revolution is a partial one
};

class LidarSimulator {
 public:
  // Times are those of the true clock, since the start of the simulation.
  static constexpr Duration kFiringPeriod{46'080};
  static constexpr Duration kPacketPeriod = kFiringPeriod * layout::kBlocks;
  static_assert(kPacketPeriod == Duration{552'960});

  LidarSimulator(Scene scene, const RigMotion& motion, const LidarOptions& options, Random random);

  [[nodiscard]] static constexpr Duration first_firing(std::uint64_t packet) noexcept {
    return kPacketPeriod * static_cast<std::int64_t>(packet);
  }
  [[nodiscard]] Azimuth rotor(Duration since_start) const noexcept;

  // The blocks of a packet. Ask for packets in order: the noise is drawn as they come.
  void fill(std::uint64_t packet, std::array<DataBlock, layout::kBlocks>& blocks);

 private:
  void fire(Duration since_start, DataBlock& block);
  [[nodiscard]] LaserReturn measure(const Hit& hit);

  Scene scene_;
  RigMotion motion_;
  LidarOptions options_;
  Random random_;
  struct Elevation {
    double cosine, sine;
  };
  std::array<Elevation, velodyne::Model::kMaxLasers> elevation_{};  // in firing order
};

}  // namespace convexcut::sim
