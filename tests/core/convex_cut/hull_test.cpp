// SPDX-License-Identifier: Apache-2.0
//
// The reference's hull against the definition, the engine's and one that grows against it. The
// definition is tried on integer coordinates only, where it can be evaluated without rounding.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/convex_hull.hpp"
#include "core/convex_cut/kept_hull.hpp"
#include "core/convex_cut/reference.hpp"
#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut {
namespace {

[[nodiscard]] std::int64_t cross(const SlicePoint& a, const SlicePoint& b, const SlicePoint& c) {
  const auto whole = [](double value) { return static_cast<std::int64_t>(value); };
  return (whole(b.u) - whole(a.u)) * (whole(c.z) - whole(a.z)) -
         (whole(b.z) - whole(a.z)) * (whole(c.u) - whole(a.u));
}

// a → b is an edge of the hull: every point is on its left, or on it.
[[nodiscard]] bool is_edge(const SlicePoint& a, const SlicePoint& b,
                           const std::vector<SlicePoint>& points) {
  return a != b && std::ranges::all_of(points, [&](const SlicePoint& c) {
           const std::int64_t turn = cross(a, b, c);
           const bool within = !(c < std::min(a, b)) && !(std::max(a, b) < c);
           return turn > 0 || (turn == 0 && within);
         });
}

// The vertices in order of (u, z), by trying all pairs against all points.
[[nodiscard]] std::vector<SlicePoint> vertices_by_definition(
    const std::vector<SlicePoint>& points) {
  std::vector<SlicePoint> vertices;
  for (const SlicePoint& a : points) {
    for (const SlicePoint& b : points) {
      if (is_edge(a, b, points)) vertices.push_back(a);
    }
  }
  if (vertices.empty() && !points.empty()) vertices.push_back(points.front());  // all are equal
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

[[nodiscard]] std::vector<SlicePoint> random_points(test::Random& random, std::size_t count,
                                                    double side) {
  std::vector<SlicePoint> points(count);
  for (SlicePoint& point : points) {
    point = {std::floor(random.uniform(-side, side)), std::floor(random.uniform(-side, side))};
  }
  return points;
}

[[nodiscard]] std::vector<SlicePoint> corners_from_the_least(const KeptHull& hull) {
  const Polygon polygon = hull.polygon();
  std::vector<SlicePoint> corners;
  for (std::size_t k = 0; k < polygon.size; ++k) corners.push_back({polygon.u[k], polygon.z[k]});
  std::ranges::rotate(corners, std::min_element(corners.begin(), corners.end()));
  return corners;
}

TEST(ReferenceHull, HasTheVerticesThatTheDefinitionGives) {
  test::Random random(1);
  for (int i = 0; i < 300; ++i) {
    // Small sides give duplicates and collinear points, side 1 at most four places.
    constexpr double kSides[] = {1, 2, 4, 10, 1000, 1e9};
    const std::vector<SlicePoint> points =
        random_points(random, random.index(65), kSides[random.index(std::size(kSides))]);
    std::vector<SlicePoint> found = reference::hull(points);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, vertices_by_definition(points)) << i;
  }
}

TEST(ReferenceHull, GoesRoundCounterClockwiseFromTheLeastPoint) {
  test::Random random(2);
  for (int i = 0; i < 50; ++i) {
    const std::vector<SlicePoint> points = random_points(random, 40, 100);
    const std::vector<SlicePoint> hull = reference::hull(points);
    ASSERT_EQ(hull.front(), *std::min_element(points.begin(), points.end()));
    for (std::size_t k = 0; k < hull.size(); ++k) {
      ASSERT_TRUE(is_edge(hull[k], hull[(k + 1) % hull.size()], points));
    }
  }
}

TEST(ReferenceHull, DropsPointsInTheMiddleOfAnEdge) {
  EXPECT_EQ(reference::hull({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}}),
            (std::vector<SlicePoint>{{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
}

TEST(ReferenceHull, OfCollinearOrEqualPointsHasFewerThanThreeVertices) {
  EXPECT_EQ(reference::hull({{1, 1}, {0, 0}, {2, 2}}), (std::vector<SlicePoint>{{0, 0}, {2, 2}}));
  EXPECT_EQ(reference::hull({{1, 1}, {1, 1}, {1, 1}}), (std::vector<SlicePoint>{{1, 1}}));
  EXPECT_TRUE(reference::hull({}).empty());
}

TEST(ConvexHull, IsTheReferencesVertexByVertex) {
  test::Random random(3);
  for (int i = 0; i < 500; ++i) {
    std::vector<SlicePoint> points(random.index(200));
    const bool whole = random.index(2) == 0;
    for (SlicePoint& point : points) {
      point = {random.uniform(-9, 9), random.uniform(-9, 9)};
      if (whole) point = {std::floor(point.u), std::floor(point.z)};
    }
    const std::vector<SlicePoint> expected = reference::hull(points);
    std::vector<SlicePoint> vertices(points.size() + 1);
    const std::span<const SlicePoint> found = convex_hull(std::span(points), std::span(vertices));
    ASSERT_TRUE(std::ranges::equal(found, expected)) << i;
  }
}

// A few integer coordinates: collinear and equal points are common. Many: long runs of corners go.
TEST(KeptHull, IsTheConvexHullOfAllItsPoints) {
  test::Random random(17);
  KeptHull kept;
  for (int repetition = 0; repetition < 2'000; ++repetition) {
    const double side = repetition % 2 == 0 ? 4.0 : 1e4;
    std::vector<SlicePoint> points = random_points(random, 3 + random.index(40), side);
    std::vector<SlicePoint> vertices(points.size() + 40);
    const auto hull_of_points = [&] {
      std::vector<SlicePoint> sorted = points;
      return convex_hull(std::span(sorted), std::span(vertices));
    };
    const std::span<const SlicePoint> first = hull_of_points();
    if (first.size() < 3) continue;
    std::vector<double> u, z;
    for (const SlicePoint& vertex : first) {
      u.push_back(vertex.u);
      z.push_back(vertex.z);
    }
    kept.set({u.data(), z.data(), u.size()});
    for (const SlicePoint& point : random_points(random, 10, 1.5 * side)) {
      points.push_back(point);
      const std::vector<SlicePoint> before = corners_from_the_least(kept);
      const bool is_larger = kept.add(point);
      const std::span<const SlicePoint> hull = hull_of_points();
      const std::vector<SlicePoint> expected(hull.begin(), hull.end());
      EXPECT_EQ(corners_from_the_least(kept), expected);
      EXPECT_EQ(is_larger, before != expected);
    }
  }
}

TEST(BoundaryDistance, IsToTheNearestEdgeAsASegment) {
  const std::vector<SlicePoint> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  EXPECT_DOUBLE_EQ(reference::squared_distance_to_boundary({2, 1}, square), 1.0);
  EXPECT_DOUBLE_EQ(reference::squared_distance_to_boundary({3.5, 2}, square), 0.25);
  // Outside, beside a corner: the lines of the edges are nearer than the edges.
  EXPECT_DOUBLE_EQ(reference::squared_distance_to_boundary({7, 8}, square), 25.0);
}

}  // namespace
}  // namespace convexcut
