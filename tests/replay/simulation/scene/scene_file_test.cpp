// SPDX-License-Identifier: Apache-2.0
//
// Scene files give the surfaces that they describe, and errors with their lines. Mesh files that
// are broken in any way are refused. Does not prove that every mistake is noticed: a room with a
// floor that crosses itself is taken.
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "replay/simulation/scene/mesh.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Scene parse(const std::string& text, const SceneOptions& options = {}) {
  return Scene::parse(text + "\n[rig]\nposition = [0, 0, 1]\n", "test.toml", options);
}

// The lines of the error that a scene gives; none when it succeeds.
std::vector<std::string> errors_of(const std::string& text, const SceneOptions& options = {}) {
  std::vector<std::string> lines;
  try {
    static_cast<void>(parse(text, options));
  } catch (const SceneError& error) {
    std::istringstream all(error.what());
    for (std::string line; std::getline(all, line);) lines.push_back(line);
  }
  return lines;
}

std::string error_of_naming(const std::string& name) {
  try {
    static_cast<void>(Scene::open(name));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

struct Seen {
  std::string surface;
  double distance_m = 0.0;
};

Seen look(const Scene& scene, const Vec3& from, const Vec3& direction, double least = 0.0) {
  Hit hit;
  if (!scene.at(Duration{}).cast({from, direction.normalized(), least}, hit)) return {"nothing"};
  return {scene.surfaces()[hit.surface].name, hit.distance_m};
}

const SurfaceInfo& surface(const Scene& scene, const std::string& name) {
  for (const SurfaceInfo& each : scene.surfaces()) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(name);
}

TEST(SceneFile, RoomHasItsSidesByName) {
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

TEST(SceneFile, RoomMayHaveInclinedLevelsAndNames) {
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

TEST(SceneFile, OpeningsHaveDepthAndPanes) {
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

TEST(SceneFile, ShapesStandWhereTheyAreDescribed) {
  const Scene scene = parse(R"(
[[box]]
name = "turned"
center = [3, 0, 1]
size = [2, 1, 1]
yaw_deg = 90
[[cylinder]]
name = "pole"
base = [-3, 0, 0]
radius = 0.5
height = 2
material = "mirror"
[[cylinder]]
name = "pipe"
from = [0, -3, 0]
to = [0, -3, 4]
radius = 0.25
closed = false
[[sphere]]
name = "ball"
center = [0, 3, 1]
radius = 1
label = "dynamic"
[[rectangle]]
name = "board"
corner = [-1, -1, 3]
u = [2, 0, 0]
v = [0, 2, 0]
[[polygon]]
name = "sign"
points = [[-1, -1, -1], [1, -1, -1], [0, 1, -1]]
[[mesh]]
name = "tetrahedron"
scale = 2.0
position = [0, 0, -3]
vertices = [[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0], [0, 0, 0.5]]
faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
)");
  const Vec3 from(0, 0, 1);
  EXPECT_NEAR(look(scene, from, Vec3::UnitX()).distance_m, 2.5, 1e-12);
  EXPECT_NEAR(look(scene, from, -Vec3::UnitX()).distance_m, 2.5, 1e-12);
  EXPECT_NEAR(look(scene, from, Vec3::UnitY()).distance_m, 2.0, 1e-12);
  EXPECT_NEAR(look(scene, from, -Vec3::UnitY()).distance_m, 2.75, 1e-12);
  EXPECT_NEAR(look(scene, from, Vec3::UnitZ()).distance_m, 2.0, 1e-12);
  EXPECT_NEAR(look(scene, from, -Vec3::UnitZ()).distance_m, 2.0, 1e-12);
  const Seen mesh = look(scene, {0.2, 0.2, -1.5}, -Vec3::UnitZ());
  EXPECT_EQ(mesh.surface, "tetrahedron");
  EXPECT_NEAR(mesh.distance_m, 1.5 - 0.6, 1e-12);
  EXPECT_EQ(surface(scene, "pole").material, Material::mirror);
  EXPECT_EQ(surface(scene, "pole").label, SurfaceLabel::object);
  EXPECT_EQ(surface(scene, "ball").label, SurfaceLabel::dynamic);
}

TEST(SceneFile, TemplatesArePlacedManyTimesAndInEachOther) {
  const Scene scene = parse(R"(
[[place]]
template = "desk"
at = [[2, 0, 0], [0, 2, 90]]
z = 0.5
[template.desk]
[[template.desk.box]]
name = "top"
min = [-0.5, -0.25, 0.7]
max = [0.5, 0.25, 0.8]
[[template.desk.place]]
name = "lamp"
template = "lamp"
at = [[0.4, 0, 0]]
z = 0.8
[template.lamp]
[[template.lamp.sphere]]
center = [0, 0, 0.25]
radius = 0.125
)");
  std::vector<std::string> names;
  for (const SurfaceInfo& each : scene.surfaces()) names.push_back(each.name);
  EXPECT_THAT(names, ElementsAre("desk-0.top", "desk-0.lamp-0", "desk-1.top", "desk-1.lamp-0"));
  const Seen first = look(scene, {2.4, 0, 5}, -Vec3::UnitZ());
  EXPECT_EQ(first.surface, "desk-0.lamp-0");
  EXPECT_NEAR(first.distance_m, 5.0 - (0.5 + 0.8 + 0.375), 1e-12);
  EXPECT_EQ(look(scene, {0, 2.4, 5}, -Vec3::UnitZ()).surface, "desk-1.lamp-0");
  EXPECT_EQ(look(scene, {0.2, 1.55, 5}, -Vec3::UnitZ()).surface, "desk-1.top");
  EXPECT_EQ(look(scene, {0.4, 2, 5}, -Vec3::UnitZ()).surface, "nothing");
}

TEST(SceneFile, EveryMistakeIsToldAtOnceWithItsLine) {
  EXPECT_THAT(
      errors_of(R"(colour = "red"
[[box]]
name = "a"
min = [0, 0, 0]
max = [1, 1]
[[box]]
name = "b"
min = [0, 0, 2]
max = [1, 1, 1]
labell = "object"
[[sphere]]
center = [0, 0, 0]
radius = -1.0
label = "thing"
reflectivity = 1.5
[[cylinder]]
base = [0, 0, "up"]
radius = 0.5
[[place]]
template = "chiar"
at = [[1, 2]]
[template.chair]
[[template.chair.polygon]]
points = [[0, 0, 0], [1, 1, 1], [2, 2, 2]]
[[mover]]
template = "chair"
path = []
speed_m_s = 0
path_end = "return"
)"),
      ElementsAre(
          "test.toml:1: colour: unknown key",
          "test.toml:5: box.max: expected an array of 3 numbers, each -500 … 500, found [ 1, 1 ]",
          "test.toml:9: box.max: expected to be above min in all three",
          "test.toml:10: box.labell: unknown key; did you mean label?",
          "test.toml:13: sphere.radius: expected a number above 0, at most 1000, found -1.0",
          "test.toml:14: sphere.label: expected one of structure, object, dynamic, found \"thing\"",
          "test.toml:15: sphere.reflectivity: expected a number 0 … 1, found 1.5",
          "test.toml:16: cylinder.height: missing, expected a number above 0, at most 1000",
          "test.toml:17: cylinder.base: expected an array of 3 numbers, each -500 … 500, "
          "found [ 0, 0, 'up' ]",
          "test.toml:20: place.template: no template \"chiar\"; did you mean chair?",
          "test.toml:21: place.at: expected a row: an array of 3 numbers, each -500 … 500, "
          "found [ 1, 2 ]",
          "test.toml:24: template.chair.polygon.points: expected corners of a polygon, found them "
          "on one line",
          "test.toml:27: mover.path: expected an array of at least 1 rows, each an array of 3 "
          "numbers, each -500 … 500, found []",
          "test.toml:28: mover.speed_m_s: expected a number above 0, at most 100, found 0",
          "test.toml:29: mover.path_end: expected one of loop, back, stop, found \"return\""));
}

TEST(SceneFile, MistakesInRoomsAreTold) {
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

TEST(SceneFile, WhatDoesNotFitTogetherIsTold) {
  const std::string box = "[[box]]\nname = \"a\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n";
  EXPECT_THAT(errors_of(box + box),
              ElementsAre("test.toml:5: name: \"a\" is the name of line 1 too, expected another"));
  EXPECT_THAT(errors_of(""), ElementsAre(HasSubstr("no surfaces")));
  EXPECT_THAT(errors_of(box + "[box]\n"), ElementsAre(HasSubstr("not valid TOML")));
  EXPECT_THAT(errors_of(box + "[people]\ncount = 2\n"),
              ElementsAre(HasSubstr("people.route: missing")));
  EXPECT_THAT(errors_of(box, {.people = 3}), ElementsAre(HasSubstr("the scene has no [people]")));
  EXPECT_THAT(errors_of("[template.a]\n[[template.a.place]]\ntemplate = \"a\"\n"
                        "at = [[0, 0, 0]]\n" +
                        box),
              ElementsAre("test.toml:3: template.a.place.template: expected a template that is not "
                          "made of this one"));
  EXPECT_THAT(errors_of("[template.far]\n[[template.far.sphere]]\ncenter = [400, 0, 0]\n"
                        "radius = 1\n[[place]]\ntemplate = \"far\"\nat = [[200, 0, 0]]\n"),
              ElementsAre(HasSubstr("expected all surfaces within ±500 m")));
  EXPECT_THAT(errors_of("box = 3\n"),
              ElementsAre("test.toml:1: box: expected tables, [[box]], found 3"));
  EXPECT_THAT(errors_of("[[box]]\nname = 3\nmin = [0, 0, 0]\nmax = [1, 1, nan]\n").size(), 2U);
}

TEST(SceneFile, TemplatesThatMultiplyWithoutEndAreRefused) {
  std::string text = "[template.t0]\n[[template.t0.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
  for (int i = 1; i <= 8; ++i) {
    const std::string name = "template.t" + std::to_string(i);
    text += "[" + name + "]\n[[" + name + ".place]]\ntemplate = \"t" + std::to_string(i - 1) +
            "\"\nat = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0], [5, 0, 0]]\n";
  }
  EXPECT_THAT(errors_of(text + "[[place]]\ntemplate = \"t8\"\nat = [[0, 0, 0]]\n"),
              ::testing::Contains(HasSubstr("too many: a scene has less than 65535 surfaces")));
}

TEST(SceneFile, NamesAndFilesThatAreNoneAreTold) {
  EXPECT_EQ(error_of_naming("offices"),
            "unknown scene \"offices\", expected a file or one of cafe, corridor, glass-offices, "
            "hall, house, l-shape, library, office");
  EXPECT_THAT(error_of_naming("./offices"), HasSubstr("./offices: cannot open: No such file"));
  EXPECT_THAT(error_of_naming("offices.toml"), HasSubstr("offices.toml: cannot open"));
  EXPECT_THAT(error_of_naming("/tmp"), HasSubstr("/tmp: is a directory, expected a scene file"));
}

// --- mesh files ----------------------------------------------------------------------------------

class MeshFile : public ::testing::Test {
 protected:
  MeshFile()
      : directory_(std::filesystem::temp_directory_path() /
                   ("convexcut-mesh-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(directory_);
  }
  ~MeshFile() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(directory_ / name, std::ios::binary) << content;
    return directory_ / name;
  }

  std::filesystem::path directory_;
};

constexpr const char* kQuadObj =
    "# a square and a triangle\nmtllib x.mtl\nv 0 0 0\nv 1 0 0\r\nv 1 1 0 1.0\nv 0 1 0\nvn 0 0 1\n"
    "vt 0 0\nusemtl wood\nf 1/1/1 2/1/1 3//1 4\nv 0.5 0.5 1e0\nf -1 -5 -4\n";

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by hand\nelement vertex 5\n"
         "property float x\nproperty float y\nproperty double z\nproperty uchar red\n"
         "element face 2\nproperty list uchar int vertex_indices\nproperty short flag\n"
         "end_header\n";
}

std::string ascii_ply() {
  return ply_header("ascii") +
         "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0 255\n0.5 0.5 1 255\n4 0 1 2 3 -1\n3 4 0 1 -1\n";
}

template <class Value>
void put(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_ply() {
  std::string bytes = ply_header("binary_little_endian");
  const float xy[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5F, 0.5F}};
  for (int i = 0; i < 5; ++i) {
    put(bytes, xy[i][0]);
    put(bytes, xy[i][1]);
    put(bytes, i == 4 ? 1.0 : 0.0);
    put(bytes, std::uint8_t{255});
  }
  const std::vector<std::vector<std::int32_t>> faces{{0, 1, 2, 3}, {4, 0, 1}};
  for (const auto& face : faces) {
    put(bytes, static_cast<std::uint8_t>(face.size()));
    for (const std::int32_t index : face) put(bytes, index);
    put(bytes, std::int16_t{-1});
  }
  return bytes;
}

void expect_square_and_triangle(const Mesh& mesh) {
  ASSERT_EQ(mesh.vertices.size(), 5U);
  EXPECT_TRUE(mesh.vertices[4].isApprox(Vec3(0.5, 0.5, 1.0)));
  EXPECT_THAT(mesh.triangles, ElementsAre(Mesh::Triangle{0, 1, 2}, Mesh::Triangle{0, 2, 3},
                                          Mesh::Triangle{4, 0, 1}));
}

TEST_F(MeshFile, ObjAndBothKindsOfPlyGiveTheSame) {
  expect_square_and_triangle(read_mesh(write("a.obj", kQuadObj)));
  expect_square_and_triangle(read_mesh(write("a.ply", ascii_ply())));
  expect_square_and_triangle(read_mesh(write("b.PLY", binary_ply())));
}

TEST_F(MeshFile, IsFoundBesideTheSceneAndPlaced) {
  write("chair.ply", binary_ply());
  const auto file = write("room.toml", R"([rig]
position = [0, 0, 0]
[[mesh]]
name = "chair"
file = "chair.ply"
position = [2, 0, 0]
yaw_deg = 90
scale = 2
)");
  const Scene scene = Scene::load(file);
  EXPECT_EQ(scene.name(), "room");
  // The square is now at x = 0 … 2, y = 0 … 2.
  EXPECT_NEAR(look(scene, {0.5, 1.9, 5}, -Vec3::UnitZ()).distance_m, 5.0, 1e-12);
  EXPECT_EQ(look(scene, {2.5, 1, 5}, -Vec3::UnitZ()).surface, "nothing");
  EXPECT_THAT(errors_of("[[mesh]]\nfile = \"none.ply\"\n"),
              ElementsAre(HasSubstr("test.toml:2: mesh.file: none.ply: cannot open")));
  EXPECT_THAT(errors_of("[[mesh]]\nfile = \"chair.stl\"\n"),
              ElementsAre(HasSubstr("expected a file named .obj or .ply")));
  EXPECT_THAT(errors_of("[[mesh]]\nvertices = [[0,0,0],[1,0,0],[0,1,0]]\nfaces = [[0, 1, 3]]\n"),
              ElementsAre(HasSubstr("each 0 … 2, found [ 0, 1, 3 ]")));
}

std::string mesh_error(Mesh (*read)(std::string_view, std::string_view), std::string_view content) {
  try {
    static_cast<void>(read(content, "m"));
  } catch (const MeshError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeshReader, RefusesBrokenObj) {
  EXPECT_EQ(mesh_error(read_obj, "v 1 2\n"), "m:1: expected three numbers after v");
  EXPECT_EQ(mesh_error(read_obj, "v 1 2 x\n"), "m:1: expected three numbers after v");
  EXPECT_EQ(mesh_error(read_obj, "v 1 2 nan\n"), "m:1: expected three numbers after v");
  EXPECT_EQ(mesh_error(read_obj, "v 1 2 1e300\n"), "m:1: expected three numbers after v");
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const char* no_vertex = "m:4: expected numbers of vertices above this line after f";
  for (const char* face : {"f 1 2 4\n", "f 0 1 2\n", "f 1 2 -4\n", "f 1 2 x\n", "f 1 2 /3\n",
                           "f 99999999999999999999 1 2\n"}) {
    EXPECT_EQ(mesh_error(read_obj, three + face), no_vertex);
  }
  EXPECT_EQ(mesh_error(read_obj, three + "f 1 2\n"),
            "m:4: expected at least three vertices after f");
  EXPECT_THAT(mesh_error(read_obj, three), HasSubstr("m: no faces"));
  EXPECT_THAT(mesh_error(read_obj, ""), HasSubstr("m: no faces"));
}

TEST(MeshReader, RefusesBrokenPly) {
  const auto with = [](std::string from, const std::string& what, const std::string& by) {
    from.replace(from.find(what), what.size(), by);
    return from;
  };
  const std::string good = ascii_ply();
  EXPECT_EQ(mesh_error(read_ply, good), "no error");
  EXPECT_EQ(mesh_error(read_ply, "solid"), "m:1: expected \"ply\"");
  EXPECT_THAT(mesh_error(read_ply, with(good, "ascii", "binary_big_endian")),
              HasSubstr("m:2: expected format ascii or binary_little_endian"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "vertex 5", "vertex 4000000000")),
              HasSubstr("m:4: expected an element's name and a count that the file can hold"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "vertex 5", "vertex -5")), HasSubstr("m:4:"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "float x", "single x")), HasSubstr("m:5:"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "list uchar", "list float")), HasSubstr("m:10:"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "end_header", "end_head")), HasSubstr("m:12:"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "property double z\n", "")), HasSubstr("m: "));
  EXPECT_THAT(mesh_error(read_ply, with(good, "3 4 0 1", "3 5 0 1")),
              HasSubstr("a face of vertices that do not exist"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "3 4 0 1", "3 -1 0 1")),
              HasSubstr("a face of vertices that do not exist"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "3 4 0 1", "999999999 4 0 1")),
              HasSubstr("a list that is longer than the file"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "0.5 0.5", "0.5 inf")),
              HasSubstr("expected x, y and z of each vertex"));
}

TEST(MeshReader, EveryTruncationOfAPlyIsRefused) {
  for (const std::string& whole : {ascii_ply(), binary_ply()}) {
    // The last characters of the text are a property that is read as a shorter number, and blanks.
    for (std::size_t length = 0; length + 2 < whole.size(); ++length) {
      const std::string error = mesh_error(read_ply, std::string_view(whole).substr(0, length));
      ASSERT_NE(error, "no error") << length;
    }
  }
}

TEST(MeshReader, AnyByteOfABinaryPlyMayBeWrong) {
  const std::string whole = binary_ply();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const unsigned flip : {0x01U, 0x80U, 0xFFU}) {
      std::string broken = whole;
      broken[i] = static_cast<char>(static_cast<unsigned char>(broken[i]) ^ flip);
      try {
        const Mesh mesh = read_ply(broken, "m");
        for (const Mesh::Triangle& triangle : mesh.triangles) {
          for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.vertices.size());
        }
      } catch (const MeshError& error) {
        ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
    }
  }
}

}  // namespace
}  // namespace convexcut::simulation
