// SPDX-License-Identifier: Apache-2.0
//
// Scene files give the surfaces that they describe, and errors with their lines. Does not prove
// that every mistake is noticed.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

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

std::string error_of_naming(const std::string& name) {
  try {
    static_cast<void>(Scene::open(name));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
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

}  // namespace
}  // namespace convexcut::simulation
