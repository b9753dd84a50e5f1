// SPDX-License-Identifier: Apache-2.0
//
// What moves in a scene: where it goes, and the rigid parts that it is made of.
#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "core/angle.hpp"
#include "core/geometry.hpp"
#include "core/time.hpp"
#include "replay/simulation/scene/geometry.hpp"
#include "replay/simulation/scene/path.hpp"

namespace convexcut::simulation {

// To and fro between two points as things fly that are thrown, resting in between at each.
class Flight {
 public:
  // flight > 0, rest ≥ 0.
  Flight(Vec3 from, Vec3 to, Duration flight, Duration rest) noexcept;
  [[nodiscard]] Vec3 at(Duration since_start) const noexcept;

 private:
  Vec3 from_;
  Vec3 to_;
  double flight_s_;
  double rest_s_;
};

// A rigid part of a mover. Its geometry is in the mover's frame (origin on the way, x ahead, z up)
// as it stands still.
struct MoverPart {
  Geometry geometry;
  Vec3 joint;     // swings about the y axis through this point as the mover walks
  Radians swing;  // forwards at most; negative: the other way round
};

struct Mover {
  std::variant<Path, Flight> way;
  bool turns = true;      // looks where it goes; otherwise always along `yaw`
  Radians yaw;            // of its x axis: from the heading, or from the world's
  double stride_m = 1.4;  // two steps, after which the limbs are where they were
  std::vector<MoverPart> parts;
};

// Where a part is at an instant.
struct PartPose {
  Eigen::Matrix3d part_from_world = Eigen::Matrix3d::Identity();
  Vec3 origin_world = Vec3::Zero();  // p_part = part_from_world · (p_world − origin_world)

  // Around a box of the part, in the world.
  [[nodiscard]] Bounds around(const Bounds& bounds_part) const noexcept;
};

// The poses of a mover's parts, in their order, into `poses` (one a part).
void place_parts(const Mover& mover, Duration since_start, PartPose* poses) noexcept;

// A person of this height on its feet: trunk with head, two arms, two legs.
[[nodiscard]] std::vector<MoverPart> person_parts(double height_m, std::uint32_t surface);

}  // namespace convexcut::simulation
