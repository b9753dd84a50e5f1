// SPDX-License-Identifier: Apache-2.0
//
// The solids that a simulated room is made of, and where a ray meets them. Metres, frame level.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/angle.hpp"
#include "core/geometry.hpp"

namespace convexcut::sim {

enum class Surface : std::uint8_t { wall, floor, ceiling, pillar, furniture, person };

// What stays when the room is cleared.
[[nodiscard]] constexpr bool is_structure(Surface surface) noexcept {
  return surface <= Surface::pillar;
}

struct Ray {
  Vec3 origin;
  Vec3 direction;  // unit length
};

struct Hit {
  double range_m = std::numeric_limits<double>::infinity();  // infinite: nothing was met
  double cos_incidence = 0.0;  // 1 where the ray meets the surface at a right angle
  Surface surface = Surface::wall;
};

// Each meet() replaces `nearest` when the solid is met before it, from outside, at a range > 0.

// An upright box, turned about z.
class Box {
 public:
  Box(Vec3 centre, const Vec3& size, Degrees yaw, Surface surface) noexcept;
  void meet(const Ray& ray, Hit& nearest) const noexcept;
  void shift(const Vec3& by) noexcept { centre_ += by; }
  [[nodiscard]] Vec3 middle() const noexcept { return centre_; }
  // From the middle to the farthest point.
  [[nodiscard]] double reach() const noexcept { return half_size_.norm(); }

 private:
  Vec3 centre_;
  Vec3 half_size_;
  double cos_yaw_;
  double sin_yaw_;
  Surface surface_;
};

// An upright cylinder with its two ends.
class Cylinder {
 public:
  // `foot` is the middle of the lower end.
  Cylinder(Vec3 foot, double radius, double height, Surface surface) noexcept
      : foot_(std::move(foot)), radius_(radius), height_(height), surface_(surface) {}
  void meet(const Ray& ray, Hit& nearest) const noexcept;
  void shift(const Vec3& by) noexcept { foot_ += by; }
  [[nodiscard]] Vec3 middle() const noexcept { return foot_ + Vec3(0.0, 0.0, height_ / 2.0); }
  [[nodiscard]] double reach() const noexcept { return std::hypot(radius_, height_ / 2.0); }

 private:
  Vec3 foot_;
  double radius_;
  double height_;
  Surface surface_;
};

// The shell of a room, seen from inside: four walls, floor and ceiling along the axes.
class RoomShell {
 public:
  RoomShell(Vec3 low, Vec3 high) noexcept : low_(std::move(low)), high_(std::move(high)) {}
  // The ray starts inside: it always meets a side.
  [[nodiscard]] Hit meet(const Ray& ray) const noexcept;
  [[nodiscard]] bool contains(const Vec3& p) const noexcept {
    return (p.array() > low_.array()).all() && (p.array() < high_.array()).all();
  }

 private:
  Vec3 low_;
  Vec3 high_;
};

}  // namespace convexcut::sim
