// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/rig_motion.hpp"

#include <cmath>
#include <numbers>

namespace convexcut::sim {
namespace {

constexpr double kGravity = 9.81;  // m/s²

// Roll and pitch swing at frequencies without a small common multiple: the lean never repeats
// within a demo. Phases differ, so that the rig does not start upright.
struct Swing {
  double hz;
  double phase;
};
constexpr Swing kRollSwing{.hz = 0.31, .phase = 0.4};
constexpr Swing kPitchSwing{.hz = 0.23, .phase = 1.9};

struct Attitude {  // roll, pitch, yaw as in core/geometry.hpp, radians
  double roll, pitch, yaw;
  double roll_rate, pitch_rate, yaw_rate;  // rad/s
};

Attitude attitude(const RigMotionOptions& options, Duration since_start) noexcept {
  const double t = std::chrono::duration<double>(since_start).count();
  // cos(lean) = cos(roll)·cos(pitch): with both at tilt/√2 the lean stays within the tilt.
  const double amplitude = options.tilt.to_radians().value / std::numbers::sqrt2;
  const double turn = options.turn_per_second.to_radians().value;
  const double roll_omega = 2.0 * std::numbers::pi * kRollSwing.hz;
  const double pitch_omega = 2.0 * std::numbers::pi * kPitchSwing.hz;
  return {.roll = amplitude * std::sin(roll_omega * t + kRollSwing.phase),
          .pitch = amplitude * std::sin(pitch_omega * t + kPitchSwing.phase),
          .yaw = turn * t,
          .roll_rate = amplitude * roll_omega * std::cos(roll_omega * t + kRollSwing.phase),
          .pitch_rate = amplitude * pitch_omega * std::cos(pitch_omega * t + kPitchSwing.phase),
          .yaw_rate = turn};
}

Quaternion rotation(const Attitude& a) noexcept {
  return to_quaternion(
      {to_degrees(Radians{a.roll}), to_degrees(Radians{a.pitch}), to_degrees(Radians{a.yaw})});
}

}  // namespace

Quaternion RigMotion::q_level_from_rig(Duration since_start) const noexcept {
  return rotation(attitude(options_, since_start));
}

RigState RigMotion::state(Duration since_start) const noexcept {
  const Attitude a = attitude(options_, since_start);
  const Quaternion q = rotation(a);
  // Body rates of R = Rz(yaw)·Ry(pitch)·Rx(roll).
  const Vec3 omega(
      a.roll_rate - a.yaw_rate * std::sin(a.pitch),
      a.pitch_rate * std::cos(a.roll) + a.yaw_rate * std::cos(a.pitch) * std::sin(a.roll),
      -a.pitch_rate * std::sin(a.roll) + a.yaw_rate * std::cos(a.pitch) * std::cos(a.roll));
  return {q, omega, q.conjugate() * Vec3(0.0, 0.0, kGravity)};
}

}  // namespace convexcut::sim
