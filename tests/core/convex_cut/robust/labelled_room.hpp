// SPDX-License-Identifier: Apache-2.0
//
// Revolutions of an HDL-32E in rooms of boxes, with what each point was on. Sharp beams, no loss:
// what a sensor gets wrong is the simulator's matter.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/cloud.hpp"
#include "core/geometry.hpp"
#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut::test {

struct RoomBox {
  Vec3 low, high;
};

struct LabelledCloud {
  Cloud cloud;
  std::vector<int> box;  // index of the box, kWalls or kGhost
};

inline constexpr int kWalls = -1;
inline constexpr int kGhost = -2;

// The lidar is the origin.
struct BoxRoom {
  RoomBox walls{{-4.0, -3.0, -1.2}, {4.0, 3.0, 1.6}};
  std::vector<RoomBox> boxes{};
  // A mirror in the wall y = walls.low.y: x and z from … to.
  bool has_mirror = false;
  std::array<double, 4> mirror{-1.0, 1.0, -0.6, 0.8};
};

struct Sight {
  double tilt_deg = 0.0;
  double yaw_deg = 0.0;
  double noise_m = 0.02;
  double ghosts = 0.0;           // share of the points that are anywhere along their ray
  double ghosts_beyond_m = 6.0;  // and as far behind what it meets
  double gravity_deg = 0.0;      // the cloud is turned by it about y
  Vec3 position = Vec3::Zero();  // in the middle of the revolution
  Vec3 step = Vec3::Zero();      // of the lidar from its start to its end
  std::uint64_t seed = 1;
  int firings = 1085;  // every other one of a sensor at 10 Hz
};

// Where the ray enters or, from within, leaves the box; NaN: never.
[[nodiscard]] inline double meet(const RoomBox& box, const Vec3& from, const Vec3& ray,
                                 bool from_within) {
  double enter = -1e9;
  double leave = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.low[axis] - from[axis]) / ray[axis];
    const double b = (box.high[axis] - from[axis]) / ray[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (from_within) return leave;
  return enter < leave && enter > 1e-6 ? enter : std::nan("");
}

struct Meeting {
  double range = 0.0;
  int box = kWalls;
};

[[nodiscard]] inline Meeting look(const BoxRoom& room, const Vec3& from, const Vec3& ray) {
  Meeting meeting{meet(room.walls, from, ray, true), kWalls};
  for (std::size_t i = 0; i < room.boxes.size(); ++i) {
    const double range = meet(room.boxes[i], from, ray, false);
    if (range < meeting.range) meeting = {range, static_cast<int>(i)};
  }
  const Vec3 at = from + meeting.range * ray;
  const auto& [x0, x1, z0, z1] = room.mirror;
  if (room.has_mirror && meeting.box == kWalls && std::abs(at.y() - room.walls.low.y()) < 1e-6 &&
      at.x() > x0 && at.x() < x1 && at.z() > z0 && at.z() < z1) {
    BoxRoom rest = room;
    rest.has_mirror = false;
    const Vec3 back(ray.x(), -ray.y(), ray.z());
    return {meeting.range + look(rest, at + 1e-6 * back, back).range, kGhost};
  }
  return meeting;
}

[[nodiscard]] inline LabelledCloud revolution_in(const BoxRoom& room, const Sight& sight) {
  constexpr int kLasers = 32;
  constexpr double kDegree = std::numbers::pi / 180.0;
  Random random(sight.seed);
  LabelledCloud result;
  const Quaternion q = to_quaternion({{0.0}, {sight.tilt_deg}, {sight.yaw_deg}});
  const Quaternion q_gravity = to_quaternion({{0.0}, {sight.gravity_deg}, {0.0}});
  for (int firing = 0; firing < sight.firings; ++firing) {
    const double azimuth = 2.0 * std::numbers::pi * firing / sight.firings;
    const Vec3 from =
        sight.position + (static_cast<double>(firing) / sight.firings - 0.5) * sight.step;
    for (int laser = 0; laser < kLasers; ++laser) {
      const double elevation = (-30.67 + laser * 41.34 / 31.0) * kDegree;
      const Vec3 ray = q * Vec3(std::cos(elevation) * std::cos(azimuth),
                                -std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      Meeting meeting = look(room, from, ray);
      meeting.range += sight.noise_m * random.normal();
      if (sight.ghosts > 0.0 && random.uniform(0.0, 1.0) < sight.ghosts) {
        meeting = {random.uniform(1.0, meeting.range + sight.ghosts_beyond_m), kGhost};
      }
      const Vec3 p = q_gravity * (meeting.range * ray);
      result.cloud.add(p.x(), p.y(), p.z());
      result.box.push_back(meeting.box);
    }
  }
  return result;
}

}  // namespace convexcut::test
