// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/rig_motion.hpp"

#include <cmath>
#include <numbers>

#include "replay/simulation/rig/attitude.hpp"

namespace convexcut::sim {

using simulation::Attitude;

namespace {

// Roll and pitch swing at frequencies without a small common multiple: the lean never repeats
// within a demo. Phases differ, so that the rig does not start upright.
struct Swing {
  double hz;
  double phase;
};
constexpr Swing kRollSwing{.hz = 0.31, .phase = 0.4};
constexpr Swing kPitchSwing{.hz = 0.23, .phase = 1.9};

Attitude attitude(const RigMotionOptions& options, Duration since_start) noexcept {
  const double t = std::chrono::duration<double>(since_start).count();
  // cos(lean) = cos(roll)·cos(pitch): with both at tilt/√2 the lean stays within the tilt.
  const double amplitude = options.tilt.to_radians().value / std::numbers::sqrt2;
  const double turn = options.turn_per_second.to_radians().value;
  const double roll_omega = 2.0 * std::numbers::pi * kRollSwing.hz;
  const double pitch_omega = 2.0 * std::numbers::pi * kPitchSwing.hz;
  return {.roll = {amplitude * std::sin(roll_omega * t + kRollSwing.phase)},
          .pitch = {amplitude * std::sin(pitch_omega * t + kPitchSwing.phase)},
          .yaw = {turn * t},
          .roll_rad_s = amplitude * roll_omega * std::cos(roll_omega * t + kRollSwing.phase),
          .pitch_rad_s = amplitude * pitch_omega * std::cos(pitch_omega * t + kPitchSwing.phase),
          .yaw_rad_s = turn};
}

}  // namespace

Quaternion RigMotion::q_level_from_rig(Duration since_start) const noexcept {
  return rotation(attitude(options_, since_start));
}

RigState RigMotion::state(Duration since_start) const noexcept {
  const Attitude a = attitude(options_, since_start);
  const Quaternion q = rotation(a);
  // The rig does not travel: gravity alone.
  return {q, body_rates_rad_s(a), q.conjugate() * Vec3(0.0, 0.0, simulation::kGravity)};
}

}  // namespace convexcut::sim
