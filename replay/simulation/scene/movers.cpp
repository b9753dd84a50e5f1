// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/movers.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace convexcut::simulation {
namespace {

constexpr double kGravity = 9.81;  // m/s²

double seconds(Duration duration) noexcept {
  return std::chrono::duration<double>(duration).count();
}

struct Place {
  Vec3 position;
  Radians yaw;
  double swing = 0.0;  // −1 … 1
};

Place place_of(const Mover& mover, Duration since_start) noexcept {
  if (const auto* flight = std::get_if<Flight>(&mover.way)) {
    return {flight->at(since_start), mover.yaw};
  }
  const PathPoint point = std::get<Path>(mover.way).at(since_start);
  const double yaw = mover.yaw.value + (mover.turns ? point.heading.value : 0.0);
  const double phase = 2.0 * std::numbers::pi * point.travelled_m / mover.stride_m;
  return {point.position, {yaw}, point.moving ? std::sin(phase) : 0.0};
}

}  // namespace

Flight::Flight(Vec3 from, Vec3 to, Duration flight, Duration rest) noexcept
    : from_(std::move(from)),
      to_(std::move(to)),
      flight_s_(seconds(flight)),
      rest_s_(seconds(rest)) {}

Vec3 Flight::at(Duration since_start) const noexcept {
  const double half_s = flight_s_ + rest_s_;
  const double in_round_s = std::fmod(std::max(seconds(since_start), 0.0), 2.0 * half_s);
  const bool there = in_round_s < half_s;
  const double flown_s = std::min(there ? in_round_s : in_round_s - half_s, flight_s_);
  const double part = flown_s / flight_s_;
  Vec3 p = there ? Vec3(from_ + part * (to_ - from_)) : Vec3(to_ + part * (from_ - to_));
  // Above the straight line: what gravity takes back until the end of the flight.
  p.z() += kGravity / 2.0 * flown_s * (flight_s_ - flown_s);
  return p;
}

Bounds PartPose::around(const Bounds& bounds_part) const noexcept {
  const Vec3 middle = origin_world + part_from_world.transpose() * bounds_part.centre();
  const Vec3 reach = part_from_world.cwiseAbs().transpose() * (bounds_part.size() / 2.0);
  return {middle - reach, middle + reach};
}

void place_parts(const Mover& mover, Duration since_start, PartPose* poses) noexcept {
  const Place place = place_of(mover, since_start);
  const double cos_yaw = std::cos(place.yaw.value);
  const double sin_yaw = std::sin(place.yaw.value);
  Eigen::Matrix3d mover_from_world;
  mover_from_world << cos_yaw, sin_yaw, 0.0, -sin_yaw, cos_yaw, 0.0, 0.0, 0.0, 1.0;
  for (const MoverPart& part : mover.parts) {
    PartPose& pose = *poses++;
    // Forwards is up in front, which is a negative turn about y (to the left).
    const double angle = part.swing.value * place.swing;
    const double cos_swing = std::cos(angle);
    const double sin_swing = std::sin(angle);
    Eigen::Matrix3d part_from_mover;
    part_from_mover << cos_swing, 0.0, sin_swing, 0.0, 1.0, 0.0, -sin_swing, 0.0, cos_swing;
    pose.part_from_world = part_from_mover * mover_from_world;
    const Vec3 joint_world = place.position + mover_from_world.transpose() * part.joint;
    pose.origin_world = joint_world - pose.part_from_world.transpose() * part.joint;
  }
}

// Proportions after Drillis and Contini, "Body Segment Parameters" (1966), rounded.
std::vector<MoverPart> person_parts(double height_m, std::uint32_t surface) {
  const double hip = 0.50 * height_m;
  const double shoulder = 0.82 * height_m;
  const double half_hips = 0.055 * height_m;
  const double half_shoulders = 0.13 * height_m;
  const auto limb = [&](const Vec3& from, const Vec3& to, double radius) {
    return Primitive{Cylinder(from, to, radius, Cylinder::Ends::closed), surface};
  };
  std::vector<MoverPart> parts;
  std::vector<Primitive> trunk;
  const RigidTransform chest{Quaternion::Identity(), {0.0, 0.0, (hip + shoulder) / 2.0 + 0.02}};
  trunk.push_back({Block(chest, {0.10, 0.11 * height_m, (shoulder - hip) / 2.0 + 0.02}), surface});
  trunk.push_back(limb({0.0, 0.0, shoulder}, {0.0, 0.0, 0.90 * height_m}, 0.06));
  trunk.push_back({Sphere({0.02, 0.0, 0.94 * height_m}, 0.06 * height_m), surface});
  parts.push_back({Geometry(std::move(trunk)), Vec3::Zero(), Radians{}});
  constexpr Radians kLegSwing{0.40};
  constexpr Radians kArmSwing{0.30};
  for (const double side : {1.0, -1.0}) {
    const Vec3 hip_joint(0.0, side * half_hips, hip);
    const Vec3 foot(0.0, side * half_hips, 0.0);
    const RigidTransform shoe{Quaternion::Identity(), {0.06, side * half_hips, 0.04}};
    const Primitive foot_block{Block(shoe, {0.13, 0.045, 0.04}), surface};
    parts.push_back({Geometry({limb(hip_joint, foot, 0.075), foot_block}), hip_joint,
                     Radians{side * kLegSwing.value}});
    const Vec3 shoulder_joint(0.0, side * half_shoulders, shoulder);
    const Vec3 hand(0.05, side * (half_shoulders + 0.03), 0.42 * height_m);
    parts.push_back({Geometry({limb(shoulder_joint, hand, 0.045)}), shoulder_joint,
                     Radians{-side * kArmSwing.value}});
  }
  return parts;
}

}  // namespace convexcut::simulation
