// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/demo_room/thing.hpp"
#include "core/time.hpp"

namespace convexcut::sim {

// A person's way: to and fro between two points of the floor.
struct Walk {
  Vec3 from;  // on the floor
  Vec3 to;
  double speed_m_s = 1.0;
  double height_m = 1.75;
};

// A person who walks: trunk, head and arms keep together, the legs swing.
class Walker {
 public:
  explicit Walker(const Walk& walk);

  // Where the person is then. Any order of times.
  void move_to(Duration since_start) noexcept;
  void meet(const Ray& ray, Hit& nearest) const noexcept;

 private:
  Walk walk_;
  Thing trunk_;
  Thing left_leg_;
  Thing right_leg_;
  Vec3 trunk_offset_;  // of the parts, from where they were made
  Vec3 left_offset_;
  Vec3 right_offset_;
};

}  // namespace convexcut::sim
