// SPDX-License-Identifier: Apache-2.0
//
// Shapes are met where a plain, slow computation says, and the hierarchy misses nothing that trying
// every shape finds. Does not prove anything about speed, nor about coordinates beyond some ten
// metres.
#include "replay/simulation/scene/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "replay/simulation/scene/geometry.hpp"
#include "replay/simulation/scene/ray.hpp"

namespace convexcut::simulation {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : generator_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11U) * 0x1p-53;
  }
  Vec3 point(double reach) {
    return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)};
  }
  Vec3 direction() {
    Vec3 d = point(1.0);
    while (d.norm() < 0.1 || d.norm() > 1.0) d = point(1.0);
    return d.normalized();
  }
  RigidTransform place(double reach) {
    const Vec3 axis = direction();
    return {Quaternion(Eigen::AngleAxisd(uniform(-3.0, 3.0), axis)), point(reach)};
  }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(generator_() % count); }

 private:
  std::mt19937_64 generator_;
};

// Negative inside of a solid, positive outside, continuous.
using Solid = std::function<double(const Vec3&)>;

double nearest_of(const Shape& shape, const Ray& ray) {
  return std::visit([&](const auto& each) { return each.meet(ray, ray.max_distance_m); }, shape);
}

constexpr double kFar = 12.0;
constexpr double kStep = 0.004;

// Walks along the ray in small steps: the first change of sign is the surface.
void expect_first_change_of_sign(const Shape& shape, const Solid& solid, const Ray& ray) {
  const auto at = [&](double t) { return solid(ray.origin + t * ray.direction); };
  const double distance = nearest_of(shape, ray);
  const bool starts_inside = at(ray.min_distance_m) < 0.0;
  const double end = std::min(distance - 1e-7, kFar);
  for (double t = ray.min_distance_m; t < end; t += kStep) {
    ASSERT_EQ(at(t) < 0.0, starts_inside) << "passed through at " << t << " of " << distance;
  }
  if (distance == kNoHit) return;
  ASSERT_GE(distance, ray.min_distance_m);
  EXPECT_NEAR(at(distance), 0.0, 1e-9);
  // The normal is the direction in which the solid's distance grows.
  const Vec3 p = ray.origin + distance * ray.direction;
  const Vec3 normal = normal_at(shape, p);
  EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
  const double slope = (solid(p + 1e-6 * normal) - solid(p - 1e-6 * normal)) / 2e-6;
  EXPECT_NEAR(std::abs(slope), 1.0, 1e-3);
}

void expect_met_as_solid(const Shape& local, const Solid& local_solid, unsigned seed) {
  Dice random(seed);
  int hits = 0;
  for (int i = 0; i < 150; ++i) {
    const RigidTransform place = random.place(2.0);
    const RigidTransform back = place.inverse();
    const Shape shape = placed(local, place);
    const Solid solid = [&](const Vec3& p) { return local_solid(back * p); };
    Ray ray{random.point(4.0), random.direction(), random.uniform(0.0, 0.5)};
    // Half of the rays go to the shape; some start inside.
    if (i % 2 == 0) ray.direction = (place.translation - ray.origin).normalized();
    if (i % 5 == 0) ray.origin = place.translation + random.point(0.2);
    expect_first_change_of_sign(shape, solid, ray);
    if (nearest_of(shape, ray) < kNoHit) ++hits;
    const Bounds bounds = bounds_of(shape);
    if (const double t = nearest_of(shape, ray); t < kNoHit) {
      const Vec3 p = ray.origin + t * ray.direction;
      EXPECT_TRUE(((p - bounds.low).array() > -1e-9).all());
      EXPECT_TRUE(((bounds.high - p).array() > -1e-9).all());
    }
  }
  EXPECT_GT(hits, 75);
}

double distance_to_box(const Vec3& p, const Vec3& half) {
  const Vec3 q = p.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

TEST(Shapes, BlockIsMetWhereItsInsideBegins) {
  const Vec3 half(0.3, 0.8, 0.5);
  expect_met_as_solid(
      Block({}, half), [&](const Vec3& p) { return distance_to_box(p, half); }, 1);
}

TEST(Shapes, SphereIsMetWhereItsInsideBegins) {
  expect_met_as_solid(
      Sphere(Vec3::Zero(), 0.6), [](const Vec3& p) { return p.norm() - 0.6; }, 2);
}

TEST(Shapes, ClosedCylinderIsMetWhereItsInsideBegins) {
  const Cylinder cylinder({0.0, -0.7, 0.0}, {0.0, 0.7, 0.0}, 0.4, Cylinder::Ends::closed);
  const Solid solid = [](const Vec3& p) {
    const double across = std::hypot(p.x(), p.z()) - 0.4;
    const double along = std::abs(p.y()) - 0.7;
    return std::min(std::max(across, along), 0.0) +
           std::hypot(std::max(across, 0.0), std::max(along, 0.0));
  };
  expect_met_as_solid(cylinder, solid, 3);
}

// An open tube is the boundary of the endless solid, between its ends; a part has an angle too.
TEST(Shapes, TubeAndPartOfItAreMetOnTheirMantleOnly) {
  Dice random(4);
  int hits = 0;
  int in_part = 0;
  for (int i = 0; i < 3000; ++i) {
    const Cylinder tube({0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}, 0.5, Cylinder::Ends::open);
    const Cylinder part = tube.part(Vec3::UnitX(), Radians{0.3}, Radians{1.9});
    const Ray ray{random.point(1.5), random.direction(), 0.0, 20.0};
    // The plain way: the quadratic equation's two roots.
    const Vec3& o = ray.origin;
    const Vec3& d = ray.direction;
    const double a = d.x() * d.x() + d.y() * d.y();
    const double b = o.x() * d.x() + o.y() * d.y();
    const double c = o.x() * o.x() + o.y() * o.y() - 0.25;
    double expected = kNoHit;
    double expected_part = kNoHit;
    if (b * b - a * c >= 0.0) {
      for (const double sign : {1.0, -1.0}) {
        const double t = (-b + sign * std::sqrt(b * b - a * c)) / a;
        const Vec3 p = o + t * d;
        if (t < 0.0 || std::abs(p.z()) > 1.0) continue;
        expected = std::min(expected, t);
        const double angle = std::atan2(p.y(), p.x());
        if (angle >= 0.3 && angle <= 2.2) expected_part = std::min(expected_part, t);
      }
    }
    if (expected == kNoHit) {
      EXPECT_EQ(tube.meet(ray, 20.0), kNoHit);
    } else {
      ++hits;
      EXPECT_NEAR(tube.meet(ray, 20.0), expected, 1e-6);
    }
    if (expected_part == kNoHit) {
      EXPECT_EQ(part.meet(ray, 20.0), kNoHit);
    } else {
      ++in_part;
      EXPECT_NEAR(part.meet(ray, 20.0), expected_part, 1e-6);
      const Vec3 p = ray.origin + expected_part * ray.direction;
      EXPECT_TRUE(((p - part.bounds().low).array() > -1e-6).all());
      EXPECT_TRUE(((part.bounds().high - p).array() > -1e-6).all());
    }
  }
  EXPECT_GT(hits, 400);
  EXPECT_GT(in_part, 150);
  // A flat arch above the axis reaches from its ends to its top, not to the axis.
  const Cylinder arch =
      Cylinder({0, 0, 0}, {4, 0, 0}, 10.0, Cylinder::Ends::open)
          .part(Vec3::UnitZ(), Degrees{-30.0}.to_radians(), Degrees{60.0}.to_radians());
  EXPECT_NEAR(arch.bounds().low.z(), 10.0 * std::cos(std::numbers::pi / 6.0), 1e-9);
  EXPECT_NEAR(arch.bounds().high.z(), 10.0, 1e-9);
  EXPECT_NEAR(arch.bounds().high.y(), 5.0, 1e-9);
}

TEST(Shapes, ParallelogramAndTriangleAreMetWhereTheLinearSystemSays) {
  Dice random(5);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 corner = random.point(2.0);
    const Vec3 u = random.point(1.5);
    const Vec3 v = random.point(1.5);
    const Ray ray{random.point(3.0), random.direction()};
    Eigen::Matrix3d system;
    system << u, v, -ray.direction;
    const Vec3 solution = system.fullPivLu().solve(ray.origin - corner);
    const double distance = solution.z();
    const bool on_quad = distance >= 0.0 && solution.x() >= 0.0 && solution.x() <= 1.0 &&
                         solution.y() >= 0.0 && solution.y() <= 1.0;
    const bool on_triangle = on_quad && solution.x() + solution.y() <= 1.0;
    const Flat quad(corner, u, v, Flat::Form::parallelogram);
    const Flat triangle(corner, u, v, Flat::Form::triangle);
    if (on_quad) ++hits;
    const double on_quad_m = quad.meet(ray, kNoHit);
    const double on_triangle_m = triangle.meet(ray, kNoHit);
    ASSERT_EQ(on_quad_m < kNoHit, on_quad) << i;
    ASSERT_EQ(on_triangle_m < kNoHit, on_triangle) << i;
    if (on_quad) {
      EXPECT_NEAR(on_quad_m, distance, 1e-9 * (1.0 + distance));
    }
    if (on_triangle) {
      EXPECT_EQ(on_triangle_m, on_quad_m);
    }
    EXPECT_NEAR(quad.normal_at(corner).dot(u), 0.0, 1e-12);
    EXPECT_NEAR(quad.normal_at(corner).dot(v), 0.0, 1e-12);
  }
  EXPECT_GT(hits, 50);
}

// How often a loop goes round a point, by the angles that its sides are seen under.
int turns(const std::vector<Vec3>& loop, const Vec3& p, const Vec3& normal) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec3 a = loop[i] - p;
    const Vec3 b = loop[(i + 1) % loop.size()] - p;
    sum += std::atan2(a.cross(b).dot(normal), a.dot(b));
  }
  return static_cast<int>(std::lround(sum / (2.0 * std::numbers::pi)));
}

TEST(Shapes, PolygonIsMetWithinItsLoopAndNotInItsHoles) {
  const std::vector<Vec3> outer{{-1, -1, 0},   {1.2, -1, 0}, {1.2, 0.2, 0},
                                {0.3, 0.2, 0}, {0.3, 1, 0},  {-1, 1.4, 0}};
  const std::vector<Vec3> hole{{-0.7, -0.6, 0}, {-0.7, 0.5, 0}, {-0.2, 0.5, 0}, {-0.2, -0.6, 0}};
  Dice random(6);
  int in_hole = 0;
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const RigidTransform place = random.place(2.0);
    const Polygon polygon = Polygon({outer, hole}).placed(place);
    const Vec3 on_plane(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), 0.0);
    Vec3 local_direction = random.direction();
    if (std::abs(local_direction.z()) < 0.05) continue;
    const double distance = random.uniform(0.1, 3.0);
    const Ray ray{place * (on_plane - distance * local_direction),
                  place.rotation * local_direction};
    const bool is_in_hole = turns(hole, on_plane, Vec3::UnitZ()) != 0;
    const bool expected = turns(outer, on_plane, Vec3::UnitZ()) != 0 && !is_in_hole;
    ASSERT_EQ(polygon.meet(ray, kNoHit) < kNoHit, expected) << on_plane.transpose();
    if (expected) {
      EXPECT_NEAR(polygon.meet(ray, kNoHit), distance, 1e-9);
    }
    hits += expected ? 1 : 0;
    in_hole += is_in_hole ? 1 : 0;
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(in_hole, 100);
}

TEST(Shapes, NothingIsMetBeforeTheLeastNorBehindTheLargestDistance) {
  const Sphere sphere({3.0, 0.0, 0.0}, 1.0);
  const Ray ray{Vec3::Zero(), Vec3::UnitX()};
  EXPECT_EQ(sphere.meet(ray, kNoHit), 2.0);
  EXPECT_EQ(sphere.meet(ray, 2.0), kNoHit);
  EXPECT_EQ(sphere.meet({Vec3::Zero(), Vec3::UnitX(), 2.5}, kNoHit), 4.0);
  EXPECT_EQ(sphere.meet({Vec3::Zero(), Vec3::UnitX(), 4.5}, kNoHit), kNoHit);
}

TEST(Shapes, SharedEdgesOfWallsLeaveNoGap) {
  // Rays exactly into the corners of a room of rectangles, where two or three of them meet.
  const Vec3 size(8.0, 6.0, 3.0);
  std::vector<Primitive> room;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Index second = (axis + 1) % 3;
    const Eigen::Index third = (axis + 2) % 3;
    for (const double side : {0.0, 1.0}) {
      Vec3 corner = Vec3::Zero();
      corner[axis] = side * size[axis];
      const Vec3 u = size[second] * Vec3::Unit(second);
      const Vec3 v = size[third] * Vec3::Unit(third);
      room.push_back({Flat(corner, u, v, Flat::Form::parallelogram), 0});
    }
  }
  const Geometry geometry(room);
  for (const double x : {0.0, 4.0, 8.0}) {
    for (const double y : {0.0, 3.0, 6.0}) {
      for (const double z : {0.0, 1.5, 3.0}) {
        const Vec3 target(x, y, z);
        const Vec3 way = target - Vec3(4.0, 3.0, 1.5);
        if (way.norm() == 0.0) continue;
        const Ray ray{Vec3(4.0, 3.0, 1.5), way.normalized()};
        Nearest nearest(ray.max_distance_m);
        geometry.cast(ray, BoxRay(ray), nearest);
        ASSERT_NE(nearest.primitive(), nullptr) << target.transpose();
        EXPECT_NEAR(nearest.distance_m(), way.norm(), 1e-9);
      }
    }
  }
}

Shape any_shape(Dice& random) {
  const Vec3 at = random.point(6.0);
  const double size = random.uniform(0.02, 1.5);
  switch (random.index(6)) {
    case 0:
      return Sphere(at, size);
    case 1:
      return Cylinder(at, at + random.point(2.0), size / 2.0, Cylinder::Ends::closed);
    case 2:
      return Block({random.place(0.0).rotation, at}, {size, random.uniform(0.01, 1.0), 0.3});
    case 3:  // along the axes and flat: boxes without thickness
      return Flat(at, {size, 0.0, 0.0}, {0.0, size, 0.0}, Flat::Form::parallelogram);
    case 4:
      return Polygon({{at, at + Vec3(size, 0, 0), at + Vec3(size, 0, size), at + Vec3(0, 0, 1)}});
    default:
      return Flat(at, random.point(1.0), random.point(1.0), Flat::Form::triangle);
  }
}

Ray any_ray(Dice& random, int i) {
  Ray ray{random.point(8.0), random.direction()};
  if (i % 7 == 0) ray.direction = Vec3::Unit(static_cast<Eigen::Index>(random.index(3)));
  if (i % 7 == 1) ray.direction = -Vec3::Unit(static_cast<Eigen::Index>(random.index(3)));
  if (i % 3 == 0) ray.min_distance_m = random.uniform(0.0, 4.0);
  if (i % 4 == 0) ray.max_distance_m = random.uniform(1.0, 10.0);
  return ray;
}

TEST(Geometry, HierarchyFindsWhatTryingEveryShapeFinds) {
  Dice random(7);
  std::size_t hits = 0;
  for (int scene = 0; scene < 60; ++scene) {
    std::vector<Primitive> primitives;
    const std::size_t count = scene < 6 ? static_cast<std::size_t>(scene) : random.index(400) + 1;
    for (std::size_t i = 0; i < count; ++i) {
      primitives.push_back({any_shape(random), static_cast<std::uint32_t>(i)});
    }
    const Geometry geometry(primitives);
    for (int i = 0; i < 400; ++i) {
      const Ray ray = any_ray(random, i);
      Nearest nearest(ray.max_distance_m);
      Nearest plain(ray.max_distance_m);
      geometry.cast(ray, BoxRay(ray), nearest);
      geometry.cast_on_each(ray, plain);
      ASSERT_EQ(nearest.distance_m(), plain.distance_m());
      ASSERT_EQ(nearest.primitive(), plain.primitive());
      hits += plain.primitive() != nullptr ? 1U : 0U;
    }
  }
  EXPECT_GT(hits, 5000U);
}

TEST(Geometry, ManyShapesInOnePlaceAreHeldAndMet) {
  // No plane parts them: halves are made, and the depth stays bounded.
  std::vector<Primitive> primitives;
  for (std::uint32_t i = 0; i < 3000; ++i) primitives.push_back({Sphere(Vec3::Zero(), 1.0), i});
  const Geometry geometry(primitives);
  const Ray ray{{-5.0, 0.0, 0.0}, Vec3::UnitX()};
  Nearest nearest(ray.max_distance_m);
  geometry.cast(ray, BoxRay(ray), nearest);
  ASSERT_NE(nearest.primitive(), nullptr);
  EXPECT_EQ(nearest.distance_m(), 4.0);
  EXPECT_EQ(nearest.primitive()->surface, 0U);
}

TEST(Geometry, OfSurfacesInOnePlaceTheFirstIsMetInWhateverOrderTheyAreHeld) {
  Dice random(8);
  for (int i = 0; i < 200; ++i) {
    std::vector<Primitive> primitives;
    for (std::uint32_t surface = 0; surface < 12; ++surface) {
      // Blocks of several sizes with their tops in the plane z = 0.
      const Vec3 half(random.uniform(0.5, 2.0), random.uniform(0.5, 2.0), 0.5);
      const RigidTransform at{Quaternion::Identity(), {0.0, 0.0, -0.5}};
      primitives.push_back({Block(at, half), surface + 5});
    }
    for (std::size_t k = primitives.size(); k > 1; --k) {
      std::swap(primitives[k - 1], primitives[random.index(k)]);
    }
    const Geometry geometry(primitives);
    const Ray ray{{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 2.0}, -Vec3::UnitZ()};
    Nearest nearest(ray.max_distance_m);
    geometry.cast(ray, BoxRay(ray), nearest);
    ASSERT_NE(nearest.primitive(), nullptr);
    ASSERT_EQ(nearest.distance_m(), 2.0);
    ASSERT_EQ(nearest.primitive()->surface, 5U);
  }
}

TEST(Ray, MirroredLeavesAtTheAngleAtWhichItCame) {
  const Ray ray{{0.0, 0.0, 1.0}, Vec3(3.0, 0.0, -4.0).normalized(), 0.0, 10.0};
  const Hit hit{1.25, Vec3::UnitZ(), 0};
  const Ray on = mirrored(ray, hit);
  EXPECT_TRUE(on.origin.isApprox(Vec3(0.75, 0.0, 0.0)));
  EXPECT_TRUE(on.direction.isApprox(Vec3(0.6, 0.0, 0.8)));
  EXPECT_DOUBLE_EQ(on.max_distance_m, 8.75);
}

}  // namespace
}  // namespace convexcut::simulation
