// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/rig/rig_motion.hpp"

#include <numbers>

#include "replay/simulation/sin_cos.hpp"
#include "replay/simulation/stream.hpp"

namespace convexcut::simulation {
namespace {

double radians(Degrees angle) { return angle.to_radians().value; }

}  // namespace

RigMotion::RigMotion(const RigOptions& options, std::uint64_t seed)
    : options_(options),
      turns_(three_sways(radians(options.sway), Random(seed, kSwayStream, 0))),
      shifts_(three_sways(options.sway_m, Random(seed, kSwayStream, 1))) {}

Attitude RigMotion::attitude(Duration since_start) const noexcept {
  const double t = std::chrono::duration<double>(since_start).count();
  const double swing = radians(options_.tilt_swing);
  const double omega = 2.0 * std::numbers::pi * options_.tilt_swing_hz;
  const auto [sine, cosine] = sin_cos(Radians{omega * t});
  const double turn = radians(options_.rotation_per_second);
  const Sway::Motion roll = turns_[0].at(since_start);
  const Sway::Motion pitch = turns_[1].at(since_start);
  const Sway::Motion yaw = turns_[2].at(since_start);
  return {.roll = {roll.value},
          .pitch = {radians(options_.tilt) + swing * sine + pitch.value},
          .yaw = {radians(options_.yaw) + turn * t + yaw.value},
          .roll_rad_s = roll.rate,
          .pitch_rad_s = swing * omega * cosine + pitch.rate,
          .yaw_rad_s = turn + yaw.rate};
}

Pose RigMotion::pose_at(Duration since_start) const noexcept {
  Vec3 position = options_.path.at(since_start).position_m;
  for (std::size_t i = 0; i < shifts_.size(); ++i) {
    position[static_cast<Eigen::Index>(i)] += shifts_[i].at(since_start).value;
  }
  return {position, rotation(attitude(since_start))};
}

RigState RigMotion::state(Duration since_start) const noexcept {
  const Attitude a = attitude(since_start);
  const Quaternion q = rotation(a);
  Vec3 force = options_.path.at(since_start).acceleration_m_s2 + Vec3(0.0, 0.0, kGravity);
  for (std::size_t i = 0; i < shifts_.size(); ++i) {
    force[static_cast<Eigen::Index>(i)] += shifts_[i].at(since_start).acceleration;
  }
  return {q, body_rates_rad_s(a), q.conjugate() * force};
}

}  // namespace convexcut::simulation
