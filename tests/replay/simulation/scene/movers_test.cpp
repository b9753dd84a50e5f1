// SPDX-License-Identifier: Apache-2.0
//
// What moves is where its path says, at every instant and in any order of them. Does not prove that
// people look like people.
#include "replay/simulation/scene/movers.hpp"

#include <chrono>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "replay/simulation/scene/path.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "tests/support/allocations.hpp"

namespace convexcut::simulation {
namespace {

using namespace std::chrono_literals;

Scene scene_of(const std::string& movers) {
  const std::string text = R"(
[rig]
position = [0, 0, 1]
[[room]]
name = "room"
min = [-10, -10, 0]
max = [10, 10, 4]
)" + movers;
  return Scene::parse(text, "test.toml");
}

Hit along(const SceneAt& instant, const Vec3& origin, const Vec3& direction) {
  Hit hit;
  EXPECT_TRUE(instant.cast({origin, direction.normalized()}, hit));
  return hit;
}

TEST(Path, GoesToAndFro) {
  const Path path({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}}, 2.0, PathEnd::back);
  EXPECT_TRUE(path.at(0s).position.isApprox(Vec3(0, 0, 0)));
  EXPECT_TRUE(path.at(1s).position.isApprox(Vec3(2, 0, 0)));
  EXPECT_TRUE(path.at(2500ms).position.isApprox(Vec3(4, 1, 0)));
  EXPECT_DOUBLE_EQ(path.at(2500ms).heading.value, std::atan2(1.0, 0.0));
  EXPECT_TRUE(path.at(3500ms).position.isApprox(Vec3(4, 1, 0)));
  EXPECT_DOUBLE_EQ(path.at(3500ms).heading.value, std::atan2(-1.0, 0.0));
  EXPECT_TRUE(path.at(5s).position.isApprox(Vec3(2, 0, 0)));
  EXPECT_TRUE(path.at(6s).position.isApprox(Vec3(0, 0, 0)));
  EXPECT_DOUBLE_EQ(path.at(7s).travelled_m, 14.0);
  EXPECT_TRUE(path.at(-1s).position.isApprox(Vec3(0, 0, 0)));
}

TEST(Path, GoesRoundOrStops) {
  const std::vector<Vec3> square{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const Path round(square, 1.0, PathEnd::loop);
  EXPECT_TRUE(round.at(3500ms).position.isApprox(Vec3(0, 0.5, 1)));
  EXPECT_TRUE(round.at(4500ms).position.isApprox(Vec3(0.5, 0, 1)));
  const Path once(square, 1.0, PathEnd::stop);
  EXPECT_TRUE(once.at(100s).position.isApprox(Vec3(0, 1, 1)));
  EXPECT_FALSE(once.at(100s).moving);
  EXPECT_DOUBLE_EQ(once.at(100s).travelled_m, 3.0);
}

TEST(Path, PausesAtWayPointsAndBeginsWhereItIsTold) {
  const Path path({{0, 0, 0}, {2, 0, 0}}, 1.0, PathEnd::back, 3s);
  EXPECT_TRUE(path.at(2900ms).position.isApprox(Vec3(0, 0, 0)));
  EXPECT_FALSE(path.at(2900ms).moving);
  EXPECT_TRUE(path.at(4s).moving);
  EXPECT_TRUE(path.at(4s).position.isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(path.at(7900ms).position.isApprox(Vec3(2, 0, 0)));
  EXPECT_TRUE(path.at(9s).position.isApprox(Vec3(1, 0, 0)));
  const Path later({{0, 0, 0}, {2, 0, 0}}, 1.0, PathEnd::back, 3s, 1.5);
  EXPECT_TRUE(later.at(0s).position.isApprox(Vec3(1.5, 0, 0)));
  EXPECT_TRUE(later.at(500ms).position.isApprox(Vec3(2, 0, 0)));
}

TEST(Path, OfOnePointStandsStill) {
  const Path path({{1, 2, 3}}, 1.0, PathEnd::loop);
  EXPECT_TRUE(path.at(5s).position.isApprox(Vec3(1, 2, 3)));
  EXPECT_FALSE(path.at(5s).moving);
}

TEST(Flight, FallsWithGravityAndRests) {
  const Flight flight({0, 0, 1}, {3, 0, 1.5}, 1s, 500ms);
  EXPECT_TRUE(flight.at(0s).isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(flight.at(1s).isApprox(Vec3(3, 0, 1.5)));
  EXPECT_TRUE(flight.at(1400ms).isApprox(Vec3(3, 0, 1.5)));
  EXPECT_TRUE(flight.at(2500ms).isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(flight.at(3s).isApprox(flight.at(0s)));
  // Its second difference is the acceleration.
  for (const Duration t : {200ms, 600ms, 1700ms, 2200ms}) {
    constexpr double kStep = 0.1;
    const Vec3 acceleration =
        (flight.at(t + 100ms) - 2.0 * flight.at(t) + flight.at(t - 100ms)) / (kStep * kStep);
    EXPECT_NEAR(acceleration.x(), 0.0, 1e-9);
    EXPECT_NEAR(acceleration.z(), -9.81, 1e-9);
  }
}

TEST(SceneAt, BallIsWhereItFlies) {
  const Scene scene = scene_of(R"(
[template.ball]
[[template.ball.sphere]]
center = [0, 0, 0]
radius = 0.25
[[thrown]]
name = "ball"
template = "ball"
from = [-3, 5, 1]
to = [3, 5, 1]
flight_s = 1.0
)");
  const double top = 1.0 + 9.81 / 8.0;
  const SceneAt middle = scene.at(500ms);
  const Hit hit = along(middle, {0, 0, top}, Vec3::UnitY());
  EXPECT_NEAR(hit.distance_m, 4.75, 1e-9);
  EXPECT_TRUE(hit.normal.isApprox(-Vec3::UnitY()));
  EXPECT_EQ(scene.surfaces()[hit.surface].name, "ball");
  EXPECT_EQ(scene.surfaces()[hit.surface].label, SurfaceLabel::dynamic);
  EXPECT_NEAR(along(scene.at(0s), {0, 0, top}, Vec3::UnitY()).distance_m, 10.0, 1e-9);
  EXPECT_NEAR(along(scene.at(0s), {-3, 0, 1}, Vec3::UnitY()).distance_m, 4.75, 1e-9);
}

TEST(SceneAt, MoverTurnsWhereItGoes) {
  // A thin, long plate: its side is seen when it goes by, its edge when it comes.
  const Scene scene = scene_of(R"(
[template.plate]
[[template.plate.box]]
min = [-1.0, -0.05, 0.0]
max = [1.0, 0.05, 2.0]
[[mover]]
name = "plate"
template = "plate"
path = [[-4, 5, 0], [4, 5, 0], [4, -5, 0]]
path_end = "stop"
speed_m_s = 1.0
)");
  EXPECT_NEAR(along(scene.at(4s), {0.9, 0, 1}, Vec3::UnitY()).distance_m, 4.95, 1e-9);
  EXPECT_NEAR(along(scene.at(13s), {0, 0.9, 1}, Vec3::UnitX()).distance_m, 3.95, 1e-9);
  EXPECT_NEAR(along(scene.at(13s), {4.0, -8, 1}, Vec3::UnitY()).distance_m, 7.0, 1e-9);
}

TEST(SceneAt, PersonWalksStandsAndIsOneSurface) {
  const Scene scene = scene_of(R"(
[[person]]
name = "visitor"
height_m = 1.8
path = [[3, -2], [3, 2]]
speed_m_s = 1.0
pause_s = 2.0
)");
  ASSERT_EQ(scene.surfaces().size(), 7U);
  const auto visitor = [&](Duration t, double y, double z) {
    const Hit hit = along(scene.at(t), {0, y, z}, Vec3::UnitX());
    return scene.surfaces()[hit.surface].name == "visitor";
  };
  // The trunk is a box of 0.2 m depth across the way.
  EXPECT_TRUE(visitor(1s, -2.0, 1.2));
  EXPECT_TRUE(visitor(2s, -2.0, 1.2));
  EXPECT_FALSE(visitor(1s, 0.0, 1.2));
  EXPECT_TRUE(visitor(4s, 0.0, 1.2));
  EXPECT_FALSE(visitor(4s, 0.0, 1.9));
  EXPECT_TRUE(visitor(7s, 2.0, 1.2));
  EXPECT_EQ(scene.surfaces()[6].label, SurfaceLabel::dynamic);
}

TEST(SceneAt, LegsSwingInTurn) {
  const std::vector<MoverPart> parts = person_parts(1.8, 0);
  ASSERT_EQ(parts.size(), 5U);
  Mover mover;
  mover.way = Path({{0, 0, 0}, {100, 0, 0}}, 1.0, PathEnd::stop);
  mover.stride_m = 1.4;
  mover.parts = parts;
  std::vector<PartPose> poses(parts.size());
  // A quarter of a stride on, one leg is in front and the other behind, and no foot is under
  // ground.
  place_parts(mover, 350ms, poses.data());
  const auto left = poses[1].around(parts[1].geometry.bounds());
  const auto right = poses[3].around(parts[3].geometry.bounds());
  EXPECT_GT(left.centre().x(), 0.35 + 0.1);
  EXPECT_LT(right.centre().x(), 0.35 - 0.1);
  EXPECT_GT(left.low.z(), -0.12);
  // Half a stride later it is the other way round.
  place_parts(mover, 1050ms, poses.data());
  EXPECT_LT(poses[1].around(parts[1].geometry.bounds()).centre().x(), 1.05 - 0.1);
  EXPECT_GT(poses[3].around(parts[3].geometry.bounds()).centre().x(), 1.05 + 0.1);
}

TEST(SceneAt, InstantsMayComeInAnyOrderAndCopiesAreTheirOwn) {
  const Scene scene = Scene::named("office");
  const Ray ray{scene.rig().position, Vec3(0.4, 0.9, -0.05).normalized()};
  const auto distances = [&](SceneAt& instant) {
    std::vector<double> all;
    for (int i = 0; i < 200; ++i) {
      const double angle = 0.0314 * i;
      Hit hit;
      instant.cast({ray.origin, {std::cos(angle), std::sin(angle), 0.0}}, hit);
      all.push_back(hit.distance_m);
    }
    return all;
  };
  SceneAt first = scene.at(7s);
  const std::vector<double> at_7 = distances(first);
  SceneAt copy = first;
  copy.move_to(2s);
  EXPECT_NE(distances(copy), at_7);
  EXPECT_EQ(distances(first), at_7);
  copy.move_to(7s);
  EXPECT_EQ(distances(copy), at_7);
}

TEST(SceneAt, MovingAndCastingAllocateNothing) {
  const Scene scene = Scene::named("office");
  SceneAt instant = scene.at(0s);
  const std::uint64_t before = test::allocations();
  for (int i = 0; i < 2000; ++i) {
    instant.move_to(i * 10ms);
    Hit hit;
    const double angle = 0.01 * i;
    instant.cast({scene.rig().position, {std::cos(angle), std::sin(angle), 0.0}}, hit);
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace convexcut::simulation
