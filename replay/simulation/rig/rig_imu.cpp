// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/rig/rig_imu.hpp"

#include <numbers>

#include "replay/simulation/random.hpp"
#include "replay/simulation/sin_cos.hpp"
#include "replay/simulation/stream.hpp"

namespace convexcut::simulation {
namespace {

Vec3 horizontal_direction(Random random) {
  const SinCos at = sin_cos(Radians{2.0 * std::numbers::pi * random.uniform()});
  return {at.cos, at.sin, 0.0};
}

// Of length 1, any direction: the cube's corners are cut off.
Vec3 direction(Random random) {
  Vec3 v;
  do {
    v = Vec3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
  } while (v.squaredNorm() > 1.0 || v.squaredNorm() < 0.01);
  return v / v.norm();
}

Quaternion turn(const Vec3& axis, Degrees angle) {
  const SinCos half = sin_cos(Radians{angle.to_radians().value / 2.0});
  return {half.cos, half.sin * axis.x(), half.sin * axis.y(), half.sin * axis.z()};
}

}  // namespace

RigImu::RigImu(const RigMotion& motion, const ImuErrors& errors, std::uint64_t seed)
    : motion_(motion),
      q_level_from_world_(
          turn(horizontal_direction(Random(seed, kImuErrorStream, 0)), errors.gravity)),
      q_imu_from_measured_(
          turn(horizontal_direction(Random(seed, kImuErrorStream, 1)), errors.tilt)),
      rate_bias_rad_s_(errors.rate_bias_rad_s * direction(Random(seed, kImuErrorStream, 2))),
      acceleration_bias_m_s2_(errors.acceleration_bias_m_s2 *
                              direction(Random(seed, kImuErrorStream, 3))),
      wander_(three_sways(errors.wander.to_radians().value, Random(seed, kImuErrorStream, 4))) {}

RigState RigImu::state(Duration since_start) const noexcept {
  RigState state = motion_.state(since_start);
  const Quaternion wander = rotation({.roll = {wander_[0].at(since_start).value},
                                      .pitch = {wander_[1].at(since_start).value},
                                      .yaw = {wander_[2].at(since_start).value}});
  state.q_level_from_imu =
      q_level_from_world_ * state.q_level_from_imu * q_imu_from_measured_ * wander;
  state.angular_velocity_rad_s += rate_bias_rad_s_;
  state.specific_force_m_s2 += acceleration_bias_m_s2_;
  return state;
}

}  // namespace convexcut::simulation
