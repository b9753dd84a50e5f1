// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/furniture.hpp"
#include "apps/demo_room/scene.hpp"

namespace convexcut::sim {
namespace {

Vec3 room_size() { return {9.0, 7.0, 2.7}; }
// Where the lidar stands, from the room's corner: off the middle, so that no two walls are alike.
Vec3 lidar_place() { return {3.6, 2.9, 1.2}; }

// A point of the floor, given from the room's corner.
Vec3 on_floor(double x, double y) { return Vec3(x, y, 0.0) - lidar_place(); }

}  // namespace

Scene demo_room(Furnishing furnishing) {
  Scene scene(RoomShell(-lidar_place(), room_size() - lidar_place()));
  if (furnishing == Furnishing::empty) return scene;

  scene.add(make_pillar({on_floor(5.6, 4.9)}, room_size().z()));

  scene.add(make_desk({on_floor(6.6, 0.5), Degrees{180}}));
  scene.add(make_desk({on_floor(7.7, 6.4)}));
  scene.add(make_chair({on_floor(6.5, 1.25), Degrees{170}}));
  scene.add(make_chair({on_floor(7.6, 5.55), Degrees{8}}));
  scene.add(make_chair({on_floor(1.1, 4.2), Degrees{-70}}));
  scene.add(make_chair({on_floor(3.1, 5.3), Degrees{75}}));
  scene.add(make_round_table({on_floor(2.1, 4.9)}));

  scene.add(make_bookcase({on_floor(1.5, 6.82)}));
  scene.add(make_bookcase({on_floor(2.45, 6.82)}));
  scene.add(make_bookcase({on_floor(8.82, 2.3), Degrees{-90}}));
  scene.add(make_cabinet({on_floor(0.26, 1.8), Degrees{90}}));
  scene.add(make_floor_lamp({on_floor(0.45, 6.5)}));

  scene.add(Walker({.from = on_floor(1.5, 1.0), .to = on_floor(5.4, 1.5), .speed_m_s = 1.1}));
  scene.add(Walker(
      {.from = on_floor(8.2, 4.1), .to = on_floor(5.0, 3.5), .speed_m_s = 0.9, .height_m = 1.66}));
  return scene;
}

}  // namespace convexcut::sim
