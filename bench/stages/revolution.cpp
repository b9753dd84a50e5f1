// SPDX-License-Identifier: Apache-2.0
#include "bench/stages/revolution.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "drivers/velodyne/model.hpp"

namespace convexcut::bench {
namespace {

constexpr std::size_t kPackets = 180;
constexpr std::int64_t kStepUdeg = 165'888;  // of a block at 10 Hz

// From a sensor 1.1 m above the floor of a room of 9 × 7 × 2.8 m, in metres.
[[nodiscard]] double range(double azimuth, double elevation) {
  const double x = std::cos(elevation) * std::cos(azimuth);
  const double y = -std::cos(elevation) * std::sin(azimuth);
  const double z = std::sin(elevation);
  return std::min({(x > 0 ? 4.8 : -4.2) / x, (y > 0 ? 3.9 : -3.1) / y, (z > 0 ? 1.7 : -1.1) / z});
}

}  // namespace

Revolution revolution(double missing) {
  const velodyne::Model& model = velodyne::model_of(velodyne::ModelId::hdl32e);
  constexpr double kRadiansPerMillidegree = std::numbers::pi / 180'000.0;
  // The same revolution in every run. NOLINTNEXTLINE(cert-msc32-c,cert-msc51-cpp)
  std::mt19937 random(4);
  Revolution made;
  for (std::size_t p = 0; p < kPackets; ++p) {
    simulation::DataPacket packet;
    packet.first_firing = {static_cast<std::uint32_t>(p * 552'960 / 1000)};
    for (std::size_t b = 0; b < packet.blocks.size(); ++b) {
      const auto block = static_cast<std::int64_t>(p * packet.blocks.size() + b);
      packet.blocks[b].azimuth = Azimuth::from_microdegrees(block * kStepUdeg);
      const double azimuth = packet.blocks[b].azimuth.radians().value;
      const bool open = std::sin(3.0 * azimuth) < 0.5;
      for (std::size_t laser = 0; laser < model.lasers; ++laser) {
        const double noise_m = static_cast<double>(random() % 81) * 1e-3 - 0.04;
        const double ticks =
            (range(azimuth, model.elevation_mdeg[laser] * kRadiansPerMillidegree) + noise_m) *
            500.0;
        // Two thirds of what is missing is sky, the rest anything.
        const bool is_sky = open && model.ring[laser] >= 32.0 - 32.0 * missing;
        const bool is_lost = static_cast<double>(random() % 1000) < 333.0 * missing;
        if (is_sky || is_lost) continue;
        packet.blocks[b].returns[laser] = {static_cast<std::uint16_t>(ticks),
                                           static_cast<std::uint8_t>(random() % 100)};
        ++made.returns;
      }
    }
    made.packets.push_back(simulation::encode(packet));
  }
  return made;
}

OrientationTrack swaying_rig() {
  OrientationTrack track(1024);
  constexpr Duration kStep = std::chrono::microseconds{2500};
  for (Duration t = -4 * kStep; t < std::chrono::milliseconds{120}; t += kStep) {
    const double phase = 2.0 * std::numbers::pi * std::chrono::duration<double>(t).count();
    track.push(kRevolutionBegin + t, to_quaternion({Degrees{5.0 * std::sin(1.9 * phase)},
                                                    Degrees{5.0 * std::sin(1.3 * phase)},
                                                    Degrees{5.0 * std::sin(0.7 * phase)}}));
  }
  return track;
}

}  // namespace convexcut::bench
