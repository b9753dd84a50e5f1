// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/furniture.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace convexcut::sim {
namespace {

// Builds solids in the piece's own axes: origin on the floor, x to its right, y to its back.
class Workshop {
 public:
  explicit Workshop(const Place& place)
      : place_(place), turn_(to_quaternion({Degrees{0}, Degrees{0}, place.yaw})) {}

  Workshop& box(const Vec3& centre, const Vec3& size) {
    boxes_.emplace_back(place_.floor + turn_ * centre, size, place_.yaw, surface_);
    return *this;
  }
  Workshop& cylinder(const Vec3& foot, double radius, double height) {
    cylinders_.emplace_back(place_.floor + turn_ * foot, radius, height, surface_);
    return *this;
  }
  // Four legs at ±x, ±y.
  Workshop& legs(double x, double y, double radius, double height) {
    for (const double side : {-1.0, 1.0}) {
      for (const double end : {-1.0, 1.0}) cylinder({side * x, end * y, 0.0}, radius, height);
    }
    return *this;
  }
  Workshop& of(Surface surface) {
    surface_ = surface;
    return *this;
  }
  [[nodiscard]] Thing done() const { return {boxes_, cylinders_}; }

 private:
  Place place_;
  Quaternion turn_;
  Surface surface_ = Surface::furniture;
  std::vector<Box> boxes_;
  std::vector<Cylinder> cylinders_;
};

}  // namespace

Thing make_desk(const Place& place) {
  return Workshop(place)
      .box({0.0, 0.0, 0.725}, {1.6, 0.8, 0.03})
      .legs(0.75, 0.35, 0.025, 0.71)
      .box({0.55, 0.05, 0.30}, {0.42, 0.60, 0.60})  // drawers
      .box({-0.1, 0.22, 1.07}, {0.60, 0.04, 0.36})  // screen
      .box({-0.1, 0.25, 0.82}, {0.06, 0.04, 0.16})  // and its stand
      .done();
}

Thing make_chair(const Place& place) {
  return Workshop(place)
      .box({0.0, 0.0, 0.45}, {0.44, 0.44, 0.05})
      .box({0.0, -0.21, 0.72}, {0.42, 0.03, 0.44})
      .legs(0.19, 0.19, 0.018, 0.43)
      .done();
}

Thing make_bookcase(const Place& place) {
  Workshop workshop(place);
  workshop
      .box({0.0, 0.165, 1.0}, {0.9, 0.02, 2.0})   // back
      .box({-0.44, 0.0, 1.0}, {0.02, 0.35, 2.0})  // sides
      .box({0.44, 0.0, 1.0}, {0.02, 0.35, 2.0});
  // Shelves, and on each a row of books of its own height, with a gap beside it.
  constexpr std::array<double, 5> kBookHeight{0.30, 0.26, 0.22, 0.28, 0.24};
  constexpr double kPitch = 0.39;
  for (std::size_t i = 0; i < kBookHeight.size(); ++i) {
    const double shelf = 0.03 + kPitch * static_cast<double>(i);
    const double books = 0.55 + 0.06 * static_cast<double>(i);
    const double side = i % 2 == 0 ? -1.0 : 1.0;
    workshop.box({0.0, 0.0, shelf}, {0.86, 0.33, 0.02})
        .box({side * (0.42 - books / 2.0), 0.05, shelf + 0.01 + kBookHeight[i] / 2.0},
             {books, 0.20, kBookHeight[i]});
  }
  return workshop.box({0.0, 0.0, 1.99}, {0.9, 0.35, 0.02}).done();
}

Thing make_cabinet(const Place& place) {
  return Workshop(place).box({0.0, 0.0, 0.45}, {1.6, 0.5, 0.9}).done();
}

Thing make_round_table(const Place& place) {
  return Workshop(place)
      .cylinder({0.0, 0.0, 0.0}, 0.25, 0.03)
      .cylinder({0.0, 0.0, 0.03}, 0.04, 0.67)
      .cylinder({0.0, 0.0, 0.70}, 0.50, 0.03)
      .done();
}

Thing make_floor_lamp(const Place& place) {
  return Workshop(place)
      .cylinder({0.0, 0.0, 0.0}, 0.15, 0.03)
      .cylinder({0.0, 0.0, 0.03}, 0.015, 1.37)
      .cylinder({0.0, 0.0, 1.40}, 0.20, 0.30)
      .done();
}

Thing make_pillar(const Place& place, double height_m) {
  return Workshop(place)
      .of(Surface::pillar)
      .box({0.0, 0.0, height_m / 2.0}, {0.4, 0.4, height_m})
      .done();
}

}  // namespace convexcut::sim
