// SPDX-License-Identifier: Apache-2.0
//
// One simulated run: what is in it, and the lidar's part of it as datagrams with their truth.
#pragma once

#include <cstdint>

#include "core/scan/function_ref.hpp"
#include "core/time.hpp"
#include "replay/simulation/lidar/lidar_options.hpp"
#include "replay/simulation/lidar/lidar_simulator.hpp"
#include "replay/simulation/rig/rig_imu.hpp"
#include "replay/simulation/rig/rig_motion.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/wire/imu_simulator.hpp"
#include "replay/simulation/wire/lidar_link.hpp"

namespace convexcut::simulation {

// Noise densities of 0.03 °/s/√Hz and 60 µg/√Hz (MTi-30 data sheet) over the band of 400 Hz output.
inline constexpr ImuNoise kMti30Noise{.rate_of_turn_rad_s = 0.0074, .acceleration_m_s2 = 0.0083};

struct SimulationOptions {
  Duration length = std::chrono::seconds{10};  // of lidar data
  std::uint64_t seed = 1;
  // The IMUs are on before the lidar and stay on after it, so that each firing has an orientation.
  Duration imu_margin = std::chrono::milliseconds{200};
  RigOptions rig{};
  ImuErrors imu_errors{};
  LidarOptions lidar{};
  LidarLinkOptions link{};
  SerialImuOptions serial_imu{.rate_hz = 400,
                              .baud = 460800,
                              .jitter = std::chrono::microseconds{50},
                              .noise = kMti30Noise};
  CanImuOptions can_imu{.noise = kMti30Noise};

  [[nodiscard]] Period imu_period() const noexcept {
    return {.from = -imu_margin, .length = length + 2 * imu_margin};
  }
};

// A rig as the scene plans it: where it stands, and its path when `travels` (none: it stands); all
// of it so much aside in the world.
[[nodiscard]] RigOptions planned_rig(const Scene& scene, bool travels,
                                     const Vec3& aside_m = Vec3::Zero());

class LidarStream {
 public:
  using OnFiring = FunctionRef<void(const SimulatedFiring&)>;

  // Throws std::invalid_argument when an option is out of its range.
  LidarStream(const Scene& scene, const SimulationOptions& options);

  [[nodiscard]] std::uint64_t packets() const noexcept { return packets_; }
  [[nodiscard]] std::uint64_t firings() const noexcept;
  [[nodiscard]] const LidarSimulator& simulator() const noexcept { return simulator_; }

  // The next packet: its firings, then the datagrams that arrive. False: there is none left, and
  // what was still on its way has arrived.
  bool next(OnFiring on_firing, LidarLink::Emit on_datagram);

 private:
  LidarSimulator simulator_;
  LidarLink link_;
  bool dual_;
  std::uint64_t packets_;
  std::uint64_t done_ = 0;
  DataPacket packet_;
  SimulatedFiring firing_;
};

}  // namespace convexcut::simulation
