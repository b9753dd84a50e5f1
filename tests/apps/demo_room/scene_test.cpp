// SPDX-License-Identifier: Apache-2.0
//
// Solids, rays and motion by hand-worked cases. That the room looks like a room is for the eye
// (convexcut picture).
#include "apps/demo_room/scene.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "apps/demo_room/rig_motion.hpp"
#include "replay/simulation/random.hpp"

namespace convexcut::sim {

using simulation::Random;

namespace {

using namespace std::chrono_literals;

Ray ray(const Vec3& direction) { return {Vec3::Zero(), direction.normalized()}; }

template <class Solid>
Hit hit(const Solid& solid, const Ray& r) {
  Hit nearest;
  solid.meet(r, nearest);
  return nearest;
}

TEST(Box, IsMetAtItsNearFace) {
  const Box box({5, 0, 0}, {2, 1, 1}, Degrees{0}, Surface::furniture);
  const Hit h = hit(box, ray({1, 0, 0}));
  EXPECT_DOUBLE_EQ(h.range_m, 4.0);
  EXPECT_DOUBLE_EQ(h.cos_incidence, 1.0);
  EXPECT_EQ(h.surface, Surface::furniture);
  EXPECT_TRUE(std::isinf(hit(box, ray({-1, 0, 0})).range_m));
  EXPECT_TRUE(std::isinf(hit(box, ray({1, 0.2, 0})).range_m));
}

TEST(Box, TurnsAboutTheVertical) {
  const Box box({5, 0, 0}, {2, 2, 2}, Degrees{45}, Surface::furniture);
  const Hit h = hit(box, ray({1, 1e-9, 0}));
  EXPECT_NEAR(h.range_m, 5.0 - std::numbers::sqrt2, 1e-6);
  EXPECT_NEAR(h.cos_incidence, std::numbers::sqrt2 / 2, 1e-6);
}

TEST(Box, BehindSomethingNearerIsNotMet) {
  const Box box({5, 0, 0}, {2, 1, 1}, Degrees{0}, Surface::furniture);
  Hit nearest{3.0, 1.0, Surface::person};
  box.meet(ray({1, 0, 0}), nearest);
  EXPECT_DOUBLE_EQ(nearest.range_m, 3.0);
  EXPECT_EQ(nearest.surface, Surface::person);
}

TEST(Cylinder, IsMetOnItsMantleAndOnItsEnds) {
  const Cylinder cylinder({4, 0, -1}, 0.5, 2.0, Surface::person);
  EXPECT_DOUBLE_EQ(hit(cylinder, ray({1, 0, 0})).range_m, 3.5);
  EXPECT_DOUBLE_EQ(hit(cylinder, ray({1, 0, 0})).cos_incidence, 1.0);
  EXPECT_TRUE(std::isinf(hit(cylinder, ray({1, 0.2, 0})).range_m));
  EXPECT_TRUE(std::isinf(hit(cylinder, ray({-1, 0, 0})).range_m));

  const Ray from_above{Vec3(4.2, 0.1, 5.0), -Vec3::UnitZ()};
  EXPECT_DOUBLE_EQ(hit(cylinder, from_above).range_m, 4.0);
  const Ray from_below{Vec3(4.2, 0.1, -5.0), Vec3::UnitZ()};
  EXPECT_DOUBLE_EQ(hit(cylinder, from_below).range_m, 4.0);
  const Ray beside{Vec3(4.6, 0.1, 5.0), -Vec3::UnitZ()};
  EXPECT_TRUE(std::isinf(hit(cylinder, beside).range_m));
}

TEST(Cylinder, ARayOverItsNearRimMeetsTheEnd) {
  const Cylinder cylinder({4, 0, -2}, 0.5, 1.0, Surface::furniture);
  const Hit h = hit(cylinder, ray({4, 0, -1}));
  EXPECT_NEAR(h.range_m, std::sqrt(17.0), 1e-12);
}

TEST(RoomShell, IsMetFromInsideOnEverySide) {
  const RoomShell room({-1, -2, -3}, {4, 5, 6});
  EXPECT_DOUBLE_EQ(room.meet(ray({-1, 0, 0})).range_m, 1.0);
  EXPECT_DOUBLE_EQ(room.meet(ray({0, 1, 0})).range_m, 5.0);
  EXPECT_EQ(room.meet(ray({0, 1, 0})).surface, Surface::wall);
  EXPECT_EQ(room.meet(ray({0, 0, -1})).surface, Surface::floor);
  EXPECT_EQ(room.meet(ray({0, 0, 1})).surface, Surface::ceiling);
}

TEST(Thing, ItsSphereHidesNoneOfItsSolids) {
  // Wherever a solid is met on its own it is met as part of the thing as well.
  const Box box({4, 1, 0}, {1, 0.2, 2}, Degrees{30}, Surface::furniture);
  const Cylinder cylinder({4, -1, -1}, 0.2, 2.5, Surface::furniture);
  const Thing thing({box}, {cylinder});
  Random random(7, 0);
  int met = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Ray r = ray({4, random.uniform(-2.5, 2.5), random.uniform(-2.0, 2.0)});
    Hit alone;
    box.meet(r, alone);
    cylinder.meet(r, alone);
    ASSERT_EQ(hit(thing, r).range_m, alone.range_m);
    met += std::isinf(alone.range_m) ? 0 : 1;
  }
  EXPECT_GT(met, 1000);
}

TEST(Scene, ALidarOutsideItsRoomIsRefused) {
  EXPECT_THROW(Scene(RoomShell({1, 1, 1}, {2, 2, 2})), std::invalid_argument);
}

TEST(Scene, PeopleWalkToAndFro) {
  Scene scene(RoomShell({-10, -10, -1}, {10, 10, 2}));
  scene.add(Walker({.from = {3, -2, -1}, .to = {3, 2, -1}, .speed_m_s = 1.0}));
  const auto surface_at = [&](Duration time, double y) {
    scene.move_to(time);
    return scene.cast(ray({3, y, 0})).surface;  // 1 m above the floor
  };
  EXPECT_EQ(surface_at(0s, -2.0), Surface::person);
  EXPECT_EQ(surface_at(0s, 0.0), Surface::wall);
  EXPECT_EQ(surface_at(2s, 0.0), Surface::person);
  EXPECT_EQ(surface_at(4s, 2.0), Surface::person);
  EXPECT_EQ(surface_at(6s, 0.0), Surface::person);
  EXPECT_EQ(surface_at(8s, -2.0), Surface::person);
  EXPECT_EQ(surface_at(2s, 0.0), Surface::person);  // and back in time
}

TEST(DemoRoom, HoldsStructureFurnitureAndPeople) {
  const auto count = [](Furnishing furnishing) {
    const Scene scene = demo_room(furnishing);
    std::array<int, 6> surfaces{};
    for (int azimuth = 0; azimuth < 720; ++azimuth) {
      for (int elevation = -30; elevation <= 30; ++elevation) {
        const double a = azimuth * std::numbers::pi / 360;
        const double e = elevation * std::numbers::pi / 180;
        const Hit h =
            scene.cast(ray({std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}));
        ++surfaces[static_cast<std::size_t>(h.surface)];
      }
    }
    return surfaces;
  };
  for (const int rays : count(Furnishing::furnished)) EXPECT_GT(rays, 100);
  const auto empty = count(Furnishing::empty);
  EXPECT_EQ(empty[static_cast<std::size_t>(Surface::pillar)], 0);
  EXPECT_EQ(empty[static_cast<std::size_t>(Surface::furniture)], 0);
  EXPECT_EQ(empty[static_cast<std::size_t>(Surface::person)], 0);
}

TEST(RigMotion, NeverLeansFartherThanItsTilt) {
  for (const double tilt : {0.0, 5.0, 45.0}) {
    const RigMotion motion({.tilt = Degrees{tilt}});
    double farthest = 0.0;
    for (Duration t{0}; t < 60s; t += 10ms) {
      const Vec3 up = motion.q_level_from_rig(t) * Vec3::UnitZ();
      farthest = std::max(farthest, std::acos(std::min(1.0, up.z())) * 180 / std::numbers::pi);
    }
    EXPECT_LE(farthest, tilt + 1e-6);
    EXPECT_GE(farthest, 0.9 * tilt);
  }
}

TEST(RigMotion, RateOfTurnIsTheDerivativeOfTheOrientation) {
  const RigMotion motion({.tilt = Degrees{20}, .turn_per_second = Degrees{40}});
  constexpr Duration kStep = 10us;
  for (Duration t{0}; t < 5s; t += 37ms) {
    const Quaternion change =
        motion.q_level_from_rig(t - kStep).conjugate() * motion.q_level_from_rig(t + kStep);
    const Vec3 rate = 2.0 * change.vec() / (2.0 * std::chrono::duration<double>(kStep).count());
    ASSERT_TRUE(rate.isApprox(motion.state(t).angular_velocity_rad_s, 1e-5)) << t.count();
  }
}

TEST(RigMotion, SpecificForceIsGravityUpwards) {
  const RigMotion motion({.tilt = Degrees{20}});
  const RigState rig = motion.state(1234ms);
  const Vec3 in_level = rig.q_level_from_imu * rig.specific_force_m_s2;
  EXPECT_TRUE(in_level.isApprox(Vec3(0, 0, 9.81), 1e-12));
}

}  // namespace
}  // namespace convexcut::sim
