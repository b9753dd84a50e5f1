// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "apps/demo_room/shapes.hpp"

namespace convexcut::sim {

// Solids that belong together (a chair, a person), with a sphere around them: most rays miss the
// sphere and need not be tried on the solids.
class Thing {
 public:
  Thing(std::vector<Box> boxes, std::vector<Cylinder> cylinders);

  void meet(const Ray& ray, Hit& nearest) const noexcept;
  void shift(const Vec3& by) noexcept;

 private:
  std::vector<Box> boxes_;
  std::vector<Cylinder> cylinders_;
  Vec3 centre_;
  double radius_ = 0.0;
};

}  // namespace convexcut::sim
