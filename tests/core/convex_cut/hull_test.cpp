// SPDX-License-Identifier: Apache-2.0
//
// The reference's hull against the definition, and the engine's against the reference's. The
// definition is tried on integer coordinates only, where it can be evaluated without rounding.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/convex_hull.hpp"
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

TEST(BoundaryDistance, IsToTheNearestEdgeAsASegment) {
  const std::vector<SlicePoint> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  EXPECT_DOUBLE_EQ(reference::squared_distance_to_boundary({2, 1}, square), 1.0);
  EXPECT_DOUBLE_EQ(reference::squared_distance_to_boundary({3.5, 2}, square), 0.25);
  // Outside, beside a corner: the lines of the edges are nearer than the edges.
  EXPECT_DOUBLE_EQ(reference::squared_distance_to_boundary({7, 8}, square), 25.0);
}

}  // namespace
}  // namespace convexcut
