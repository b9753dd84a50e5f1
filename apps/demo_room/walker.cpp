// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/walker.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace convexcut::sim {
namespace {

// Proportions of a body, as shares of its height.
constexpr double kLegHeight = 0.47;
constexpr double kTrunkHeight = 0.36;
constexpr double kHeadHeight = 0.13;
constexpr double kNeckHeight = 1.0 - kLegHeight - kTrunkHeight - kHeadHeight;

constexpr double kHipHalfWidth = 0.10;  // m
constexpr double kShoulderHalfWidth = 0.21;
constexpr double kStride = 0.25;  // a leg swings this far to both sides of the trunk, m
constexpr double kStepsPerMetre = 1.4;

Vec3 sideways(const Walk& walk) {
  const Vec3 along = (walk.to - walk.from).normalized();
  return {-along.y(), along.x(), 0.0};
}

Cylinder part(const Vec3& foot, double radius, double height) {
  return {foot, radius, height, Surface::person};
}

Thing make_trunk(const Walk& walk) {
  const double h = walk.height_m;
  const Vec3 up = Vec3::UnitZ();
  const Vec3 hip = kLegHeight * h * up;
  const Vec3 neck = hip + kTrunkHeight * h * up;
  const Vec3 arm_foot = hip - 0.06 * h * up;
  const Vec3 shoulder = kShoulderHalfWidth * sideways(walk);
  return Thing({}, {part(hip, 0.16, kTrunkHeight * h), part(neck, 0.055, kNeckHeight * h),
                    part(neck + kNeckHeight * h * up, 0.095, kHeadHeight * h),
                    part(arm_foot + shoulder, 0.045, (kTrunkHeight + 0.04) * h),
                    part(arm_foot - shoulder, 0.045, (kTrunkHeight + 0.04) * h)});
}

Thing make_leg(const Walk& walk, double side) {
  return Thing({},
               {part(side * kHipHalfWidth * sideways(walk), 0.075, kLegHeight * walk.height_m)});
}

}  // namespace

Walker::Walker(const Walk& walk)
    : walk_(walk),
      trunk_(make_trunk(walk)),
      left_leg_(make_leg(walk, 1.0)),
      right_leg_(make_leg(walk, -1.0)),
      trunk_offset_(Vec3::Zero()),
      left_offset_(Vec3::Zero()),
      right_offset_(Vec3::Zero()) {
  move_to(Duration{0});
}

void Walker::move_to(Duration since_start) noexcept {
  const Vec3 way = walk_.to - walk_.from;
  const double length = way.norm();
  const double walked = walk_.speed_m_s * std::chrono::duration<double>(since_start).count();
  const double lap = std::fmod(walked, 2.0 * length);
  const Vec3 place = walk_.from + way / length * (lap < length ? lap : 2.0 * length - lap);
  const Vec3 swing = way / length * kStride * std::sin(std::numbers::pi * kStepsPerMetre * walked);

  const auto put = [](Thing& thing, Vec3& offset, const Vec3& wanted) {
    thing.shift(wanted - offset);
    offset = wanted;
  };
  put(trunk_, trunk_offset_, place);
  put(left_leg_, left_offset_, place + swing);
  put(right_leg_, right_offset_, place - swing);
}

void Walker::meet(const Ray& ray, Hit& nearest) const noexcept {
  trunk_.meet(ray, nearest);
  left_leg_.meet(ray, nearest);
  right_leg_.meet(ray, nearest);
}

}  // namespace convexcut::sim
