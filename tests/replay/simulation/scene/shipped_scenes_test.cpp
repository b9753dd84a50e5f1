// SPDX-License-Identifier: Apache-2.0
//
// The scenes of the program are whole rooms: closed around the rig and its way, with the labels and
// names that the evaluation counts on. Does not prove that they look like the rooms they stand for.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "replay/simulation/random.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/scene/shaft.hpp"

namespace convexcut::simulation {
namespace {

using namespace std::chrono_literals;

// Evenly over the sphere: a Fibonacci lattice.
std::vector<Vec3> directions(int count) {
  std::vector<Vec3> all;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double turn = 2.0 * std::numbers::pi * i / std::numbers::phi;
    const double across = std::sqrt(1.0 - z * z);
    all.emplace_back(across * std::cos(turn), across * std::sin(turn), z);
  }
  return all;
}

// The directions of an HDL-32E that turns upright.
std::vector<Vec3> lidar_directions() {
  std::vector<Vec3> all;
  for (int column = 0; column < 360; ++column) {
    for (int laser = 0; laser < 32; ++laser) {
      const double azimuth = column * std::numbers::pi / 180.0;
      const double elevation = (-30.67 + laser * 4.0 / 3.0) * std::numbers::pi / 180.0;
      all.emplace_back(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    }
  }
  return all;
}

std::vector<Vec3> places_of_rig(const Scene& scene) {
  std::vector<Vec3> places{scene.rig().position};
  if (scene.rig().path.empty()) return places;
  for (int i = 0; i < 40; ++i) {
    places.push_back(scene.rig().path.at(std::chrono::milliseconds(1000 * i)).position);
  }
  return places;
}

std::map<SurfaceLabel, double> parts_by_label(const Scene& scene, Duration since_start) {
  std::map<SurfaceLabel, double> parts;
  const SceneAt instant = scene.at(since_start);
  const std::vector<Vec3> all = lidar_directions();
  for (const Vec3& direction : all) {
    Hit hit;
    const bool met = instant.cast({scene.rig().position, direction}, hit);
    const SurfaceLabel label = met ? scene.surfaces()[hit.surface].label : SurfaceLabel::none;
    parts[label] += 1.0 / static_cast<double>(all.size());
  }
  return parts;
}

class ShippedScene : public ::testing::TestWithParam<std::string_view> {
 protected:
  Scene scene_ = Scene::named(GetParam());
};

TEST_P(ShippedScene, IsClosedAroundTheRigButForGlass) {
  const SceneAt instant = scene_.at(0s);
  const Bounds& bounds = scene_.bounds();
  for (const Vec3& place : places_of_rig(scene_)) {
    for (const Vec3& direction : directions(600)) {
      Hit hit;
      ASSERT_TRUE(instant.cast({place, direction}, hit))
          << "from " << place.transpose() << " to " << direction.transpose();
      const Vec3 p = place + hit.distance_m * direction;
      ASSERT_TRUE(((p - bounds.low).array() > -1e-6).all()) << p.transpose();
      ASSERT_TRUE(((bounds.high - p).array() > -1e-6).all()) << p.transpose();
      ASSERT_NEAR(hit.normal.norm(), 1.0, 1e-9);
      ASSERT_LE(hit.normal.dot(direction), 0.0);
      // Behind what light goes through there may be nothing; behind the rest there is no way out.
      const SurfaceInfo& first = scene_.surfaces()[hit.surface];
      if (first.label == SurfaceLabel::structure || first.material == Material::glass) continue;
      Hit behind;
      const double least = hit.distance_m + kBehindSurface;
      ASSERT_TRUE(instant.cast({place, direction, least}, behind)) << first.name;
    }
  }
}

TEST_P(ShippedScene, RigHasRoomOnItsWay) {
  const Scene empty = Scene::named(GetParam(), {.people = 0});
  const SceneAt instant = empty.at(0s);
  for (const Vec3& place : places_of_rig(empty)) {
    for (const Vec3& direction : directions(400)) {
      Hit hit;
      if (!instant.cast({place, direction}, hit)) continue;
      const SurfaceInfo& surface = empty.surfaces()[hit.surface];
      if (surface.label == SurfaceLabel::dynamic) continue;
      ASSERT_GT(hit.distance_m, 0.3) << surface.name << " at " << place.transpose();
    }
  }
}

TEST_P(ShippedScene, HasStructureObjectsAndUniqueNames) {
  std::set<std::string> names;
  std::set<SurfaceLabel> labels;
  for (const SurfaceInfo& surface : scene_.surfaces()) {
    EXPECT_TRUE(names.insert(surface.name).second) << surface.name;
    labels.insert(surface.label);
    EXPECT_GE(surface.reflectivity, 0.0);
    EXPECT_LE(surface.reflectivity, 1.0);
  }
  EXPECT_TRUE(labels.contains(SurfaceLabel::structure));
  EXPECT_TRUE(labels.contains(SurfaceLabel::object));
  EXPECT_FALSE(labels.contains(SurfaceLabel::none));
  EXPECT_FALSE(scene_.description().empty());
  EXPECT_EQ(scene_.name(), GetParam());
}

TEST_P(ShippedScene, TakesPeopleUpToItsMaximum) {
  const auto count = [&](int people) {
    int found = 0;
    const Scene scene = Scene::named(GetParam(), {.people = people});
    for (const SurfaceInfo& surface : scene.surfaces()) {
      found += surface.name.starts_with("people-") ? 1 : 0;
    }
    return found;
  };
  EXPECT_EQ(count(0), 0);
  EXPECT_EQ(count(5), 5);
  EXPECT_THROW(static_cast<void>(count(-1)), SceneError);
  EXPECT_THROW(static_cast<void>(count(1001)), SceneError);
}

TEST_P(ShippedScene, IsTheSameWheneverItIsRead) {
  const Scene again = Scene::parse(Scene::text_of(GetParam()), std::string(GetParam()));
  const SceneAt first = scene_.at(12345ms);
  const SceneAt second = again.at(12345ms);
  for (const Vec3& direction : directions(500)) {
    Hit a;
    Hit b;
    first.cast({scene_.rig().position, direction}, a);
    second.cast({scene_.rig().position, direction}, b);
    ASSERT_EQ(a.distance_m, b.distance_m);
    ASSERT_EQ(a.surface, b.surface);
  }
}

TEST_P(ShippedScene, InAShaftRaysMeetWhatTheyMeetWithoutIt) {
  SceneAt instant = scene_.at(0s);
  InShaft in_shaft;
  Random random(11, 0);
  const auto aside = [&](double most) {
    return Vec3(random.uniform(-most, most), random.uniform(-most, most),
                random.uniform(-most, most));
  };
  std::size_t hits = 0;
  for (const Vec3& towards : directions(400)) {
    if (random.chance(0.1))
      instant.move_to(Duration{static_cast<std::int64_t>(random.uniform(0.0, 1e10))});
    // As wide as a few firings, or much wider; some look along an axis.
    const double width = random.chance(0.1) ? 0.5 : 0.02;
    const Vec3 middle = random.chance(0.1) ? Vec3(Vec3::Unit(random.chance(0.5) ? 0 : 2)) : towards;
    Shaft shaft;
    std::vector<Ray> rays;
    for (int i = 0; i < 8; ++i) {
      rays.push_back({scene_.rig().position + aside(0.01), (middle + aside(width)).normalized()});
      shaft.add(rays.back());
    }
    shaft.widen(0.002);
    instant.gather(shaft, in_shaft);
    for (Ray& ray : rays) {
      ray.direction = (ray.direction + aside(0.001)).normalized();
      if (random.chance(0.3)) ray.min_distance_m = random.uniform(0.0, 3.0);
      if (random.chance(0.3)) ray.max_distance_m = random.uniform(1.0, 9.0);
      Hit found;
      Hit plain;
      ASSERT_EQ(instant.cast(ray, in_shaft, found), instant.cast(ray, plain));
      ASSERT_EQ(found.distance_m, plain.distance_m);
      ASSERT_EQ(found.surface, plain.surface);
      ASSERT_EQ(found.normal, plain.normal);
      hits += plain.surface != kNoSurface ? 1U : 0U;
    }
  }
  EXPECT_GT(hits, 2000U);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene,
                         ::testing::ValuesIn(Scene::names().begin(), Scene::names().end()),
                         [](const auto& tested) {
                           std::string name(tested.param);
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(ShippedScenes, AreThoseOfTheManual) {
  const std::vector<std::string_view> expected{"cafe",  "corridor", "glass-offices", "hall",
                                               "house", "l-shape",  "library",       "office"};
  EXPECT_TRUE(std::ranges::equal(Scene::names(), expected));
}

TEST(ShippedScenes, HouseHasTheNamesOfThePapersFigure) {
  const Scene scene = Scene::named("house");
  std::map<std::string, SurfaceLabel> labels;
  for (const SurfaceInfo& surface : scene.surfaces()) labels[surface.name] = surface.label;
  for (const char* name : {"C1", "C2", "F1", "F2", "P1", "P2"}) {
    ASSERT_TRUE(labels.contains(name)) << name;
    EXPECT_EQ(labels[name], SurfaceLabel::structure) << name;
  }
  for (const char* name : {"E", "D"}) {
    ASSERT_TRUE(labels.contains(name)) << name;
    EXPECT_EQ(labels[name], SurfaceLabel::object) << name;
  }
  // All of them are seen from where the rig starts.
  std::set<std::string> seen;
  const SceneAt instant = scene.at(0s);
  for (const Vec3& direction : directions(20000)) {
    Hit hit;
    instant.cast({scene.rig().position, direction}, hit);
    seen.insert(scene.surfaces()[hit.surface].name);
  }
  for (const char* name : {"C1", "C2", "F1", "F2", "P1", "P2", "E", "D"}) {
    EXPECT_TRUE(seen.contains(name)) << name;
  }
}

TEST(ShippedScenes, LibraryHidesMostOfItsWallsAndOfficeHasThePeople) {
  const Scene library = Scene::named("library");
  int below_2m = 0;
  int wall = 0;
  const SceneAt instant = library.at(0s);
  for (const Vec3& direction : lidar_directions()) {
    Hit hit;
    const Vec3& from = library.rig().position;
    instant.cast({from, direction}, hit);
    const double z = from.z() + hit.distance_m * direction.z();
    if (z < 0.1 || z > 2.0) continue;
    ++below_2m;
    wall += library.surfaces()[hit.surface].label == SurfaceLabel::structure ? 1 : 0;
  }
  EXPECT_LT(wall, 0.3 * below_2m);
  int tables = 0;
  int chairs = 0;
  for (const SurfaceInfo& surface : library.surfaces()) {
    tables += surface.name.starts_with("table-") && surface.name.ends_with(".top") ? 1 : 0;
    chairs += surface.name.starts_with("chair-") && surface.name.ends_with(".seat") ? 1 : 0;
  }
  EXPECT_EQ(tables, 9);
  EXPECT_EQ(chairs, 8);

  int people = 0;
  const Scene office = Scene::named("office");
  for (const SurfaceInfo& surface : office.surfaces()) {
    people += surface.name.starts_with("people-") ? 1 : 0;
  }
  EXPECT_EQ(people, 8);
  EXPECT_TRUE(office.bounds().high.isApprox(Vec3(9.0, 9.2, 2.7), 1e-9));
}

TEST(ShippedScenes, MorePeopleInTheOfficeAreMoreOfWhatIsSeen) {
  std::vector<double> dynamic;
  for (const int people : {0, 8, 20, 40}) {
    const Scene scene = Scene::named("office", {.people = people});
    double sum = 0.0;
    for (int i = 0; i < 5; ++i) {
      auto parts = parts_by_label(scene, std::chrono::seconds(7 * i));
      sum += parts[SurfaceLabel::dynamic] / 5.0;
    }
    dynamic.push_back(sum);
  }
  EXPECT_LT(dynamic[0], 0.03);  // the ball
  for (std::size_t i = 1; i < dynamic.size(); ++i) EXPECT_GT(dynamic[i], dynamic[i - 1] + 0.05);
  EXPECT_GT(dynamic.back(), 0.55);
}

}  // namespace
}  // namespace convexcut::simulation
