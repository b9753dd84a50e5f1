// SPDX-License-Identifier: Apache-2.0
//
// Rooms of scene files have the sides, levels and openings that they describe, and mistakes in them
// are told. Does not prove that every mistake is noticed: a floor that crosses itself is taken.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/replay/simulation/scene/scene_texts.hpp"

namespace convexcut::simulation {
namespace {

using test::errors_of;
using test::look;
using test::parse;
using test::Seen;
using test::surface;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(RoomFile, RoomHasItsSidesByName) {
  const Scene scene = parse(R"(
[[room]]
name = "r"
min = [-2, -3, 0]
max = [4, 5, 3]
reflectivity = 0.6
floor_reflectivity = 0.2
)");
  const Vec3 from(0.5, 0.25, 1.0);
  const auto expect = [&](const Vec3& direction, const std::string& name, double distance) {
    const Seen seen = look(scene, from, direction);
    EXPECT_EQ(seen.surface, name);
    EXPECT_NEAR(seen.distance_m, distance, 1e-12);
  };
  expect(-Vec3::UnitZ(), "r.floor", 1.0);
  expect(Vec3::UnitZ(), "r.ceiling", 2.0);
  expect(-Vec3::UnitY(), "r.south", 3.25);
  expect(Vec3::UnitY(), "r.north", 4.75);
  expect(-Vec3::UnitX(), "r.west", 2.5);
  expect(Vec3::UnitX(), "r.east", 3.5);
  EXPECT_EQ(surface(scene, "r.floor").reflectivity, 0.2);
  EXPECT_EQ(surface(scene, "r.north").reflectivity, 0.6);
  EXPECT_EQ(surface(scene, "r.north").label, SurfaceLabel::structure);
  EXPECT_TRUE(scene.bounds().low.isApprox(Vec3(-2, -3, 0)));
}

TEST(RoomFile, RoomMayHaveInclinedLevelsAndNames) {
  // Clockwise in the file; the walls are numbered anticlockwise all the same.
  const Scene scene = parse(R"(
[[room]]
name = "attic"
floor = [[-2, 4], [6, 4], [6, -2], [-2, -2]]
floor_plane = [0, 0.1, 0]
ceiling_plane = [3, 0, -0.25]
ceiling_name = "C2"
without = ["wall-2"]
)");
  EXPECT_NEAR(look(scene, {2, 1, 1}, -Vec3::UnitZ()).distance_m, 0.8, 1e-12);
  EXPECT_EQ(look(scene, {2, 1, 1}, Vec3::UnitZ()).surface, "C2");
  EXPECT_NEAR(look(scene, {2, 1, 1}, Vec3::UnitZ()).distance_m, 1.75, 1e-12);
  EXPECT_EQ(scene.surfaces().size(), 5U);
  int open_sides = 0;
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
    open_sides += look(scene, {2, 1, 1}, way).surface == "nothing" ? 1 : 0;
  }
  EXPECT_EQ(open_sides, 1);
}

TEST(RoomFile, OpeningsHaveDepthAndPanes) {
  const Scene scene = parse(R"(
[[room]]
name = "r"
min = [0, 0, 0]
max = [6, 4, 3]
[[room.openings]]
wall = "south"
along = [1, 2]
z = [0, 2]
[[room.openings]]
wall = "north"
along = [1, 2]
z = [1, 2]
depth = 0.3
pane = true
name = "window"
)");
  // The northern wall runs from east to west: 1 … 2 m along it is x = 4 … 5.
  EXPECT_EQ(look(scene, {1.5, 2, 1}, -Vec3::UnitY()).surface, "nothing");
  EXPECT_EQ(look(scene, {1.5, 2, 2.1}, -Vec3::UnitY()).surface, "r.south");
  EXPECT_EQ(look(scene, {2.1, 2, 1}, -Vec3::UnitY()).surface, "r.south");
  const Seen window = look(scene, {4.5, 2, 1.5}, Vec3::UnitY());
  EXPECT_EQ(window.surface, "window");
  EXPECT_NEAR(window.distance_m, 2.3, 1e-12);
  EXPECT_EQ(surface(scene, "window").material, Material::glass);
  EXPECT_EQ(surface(scene, "window").label, SurfaceLabel::structure);
  EXPECT_EQ(look(scene, {4.5, 2, 1.5}, Vec3::UnitY(), window.distance_m + kBehindSurface).surface,
            "nothing");
  // The reveal belongs to the wall.
  const Seen reveal = look(scene, {4.5, 2, 1.5}, Vec3(0.0, 2.2, 0.5));
  EXPECT_EQ(reveal.surface, "r.north");
  EXPECT_GT(reveal.distance_m * 2.2 / std::hypot(2.2, 0.5), 2.0 + 1e-6);
}

TEST(RoomFile, MistakesInRoomsAreTold) {
  const std::string room = "[[room]]\nname = \"r\"\nmin = [0, 0, 0]\nmax = [4, 3, 3]\n";
  EXPECT_THAT(errors_of(room + "openings = [{ wall = \"up\", along = [0, 1], z = [0, 1] }]\n"),
              ElementsAre("test.toml:5: room.openings.wall: expected one of south, east, north, "
                          "west, found \"up\""));
  EXPECT_THAT(errors_of(room + "openings = [{ wall = \"east\", along = [1, 3.5], z = [0, 1] }]\n"),
              ElementsAre("test.toml:5: room.openings: expected an opening within wall east, which "
                          "is 3 m long"));
  EXPECT_THAT(errors_of(room + "openings = [{ wall = \"east\", along = [0, 1], z = [0, 4] }]\n"),
              ElementsAre(HasSubstr("within wall east")));
  EXPECT_THAT(errors_of(room + "openings = [{ wall = \"east\", along = [0, 2], z = [0, 2] }, "
                               "{ wall = \"east\", along = [1, 3], z = [1, 3] }]\n"),
              ElementsAre(HasSubstr("test.toml:5: room.openings: expected openings that do not")));
  EXPECT_THAT(errors_of(room + "without = [\"roof\"]\n"),
              ElementsAre("test.toml:5: room.without: expected floor, ceiling or a wall, found "
                          "\"roof\""));
  EXPECT_THAT(errors_of("[[room]]\nfloor = [[0, 0], [1, 0], [1, 1]]\nz = [2, 2]\n"),
              ElementsAre(HasSubstr("test.toml:1: room: expected the ceiling above the floor")));
  EXPECT_THAT(errors_of("[[room]]\nfloor = [[0, 0], [1, 0], [2, 0]]\nz = [0, 2]\n"),
              ElementsAre("test.toml:1: room: expected a floor with an area"));
  EXPECT_THAT(errors_of("[[room]]\nfloor = [[0, 0], [1, 0], [1, 1]]\n"),
              ElementsAre(HasSubstr("room.z: missing")));
}

}  // namespace
}  // namespace convexcut::simulation
