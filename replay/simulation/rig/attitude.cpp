// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/rig/attitude.hpp"

#include "replay/simulation/sin_cos.hpp"

namespace convexcut::simulation {

Quaternion rotation(const Attitude& a) noexcept {
  const auto [sr, cr] = sin_cos({a.roll.value / 2.0});
  const auto [sp, cp] = sin_cos({a.pitch.value / 2.0});
  const auto [sy, cy] = sin_cos({a.yaw.value / 2.0});
  return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy};
}

Vec3 body_rates_rad_s(const Attitude& a) noexcept {
  const auto [sr, cr] = sin_cos(a.roll);
  const auto [sp, cp] = sin_cos(a.pitch);
  return {a.roll_rad_s - a.yaw_rad_s * sp, a.pitch_rad_s * cr + a.yaw_rad_s * cp * sr,
          -a.pitch_rad_s * sr + a.yaw_rad_s * cp * cr};
}

}  // namespace convexcut::simulation
