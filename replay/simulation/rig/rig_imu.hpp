// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/angle.hpp"
#include "core/geometry.hpp"
#include "core/time.hpp"
#include "replay/simulation/rig/rig_motion.hpp"
#include "replay/simulation/rig/rig_state.hpp"
#include "replay/simulation/rig/sway.hpp"

namespace convexcut::simulation {

// What an IMU of the MTi-30's class gets wrong, noise apart. Typical of its data sheet: orientation
// within 0.2° at rest and 0.5° in motion, biases of 0.2 °/s and 0.05 m/s². Directions are drawn.
struct ImuErrors {
  Degrees tilt{0.2};    // of roll and pitch, fixed in the IMU: turns with it
  Degrees wander{0.1};  // root mean square of what comes and goes within seconds, each axis
  double rate_bias_rad_s = 0.0035;
  double acceleration_bias_m_s2 = 0.05;
  Degrees gravity{0.0};  // of what it takes for the vertical, fixed in the world
};

inline constexpr ImuErrors kIdealImu{
    .tilt = {0.0}, .wander = {0.0}, .rate_bias_rad_s = 0.0, .acceleration_bias_m_s2 = 0.0};

// The rig's motion as its IMU tells it.
class RigImu {
 public:
  RigImu(const RigMotion& motion, const ImuErrors& errors, std::uint64_t seed);

  [[nodiscard]] RigState state(Duration since_start) const noexcept;

 private:
  RigMotion motion_;
  Quaternion q_level_from_world_;   // identity but for the error of gravity
  Quaternion q_imu_from_measured_;  // the tilt error
  Vec3 rate_bias_rad_s_;
  Vec3 acceleration_bias_m_s2_;
  std::array<Sway, 3> wander_;  // radians
};

}  // namespace convexcut::simulation
