// SPDX-License-Identifier: Apache-2.0
//
// Every kernel on every instruction set of this processor. The errors of u and of depths are tried
// on clouds, not proved: the design note has the bounds.
#include "core/convex_cut/slice_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/reference.hpp"
#include "tests/core/convex_cut/clouds.hpp"
#include "tests/core/convex_cut/every_simd_path.hpp"

namespace convexcut {
namespace {

// The columns of one slice, with the room that the kernels ask for.
struct Columns {
  explicit Columns(std::size_t count)
      : u(count + kKernelPadding), z(count + kKernelPadding), position(count + kKernelPadding) {}
  [[nodiscard]] SliceColumns view() { return {u.data(), z.data(), position.data()}; }
  std::vector<float> u, z;
  std::vector<std::uint32_t> position;
};

[[nodiscard]] Columns random_columns(std::size_t count, test::Random& random) {
  Columns columns(count);
  for (std::size_t k = 0; k < count; ++k) {
    columns.u[k] = static_cast<float>(random.uniform(-2, 2));
    columns.z[k] = static_cast<float>(random.uniform(-2, 2));
    columns.position[k] = static_cast<std::uint32_t>(k) | (random.index(3) == 0 ? kMarked : 0U);
  }
  return columns;
}

// A cloud whose columns can be read past their end.
struct PaddedCloud {
  explicit PaddedCloud(const test::Cloud& cloud)
      : x(cloud.x), y(cloud.y), z(cloud.z), size(cloud.size()) {
    for (std::vector<float>* column : {&x, &y, &z}) {
      column->resize(size + kKernelPadding, std::numeric_limits<float>::quiet_NaN());
    }
  }
  [[nodiscard]] CloudView view() const {
    return {std::span(x).first(size), std::span(y).first(size), std::span(z).first(size)};
  }
  std::vector<float> x, y, z;
  std::size_t size;
};

[[nodiscard]] float extent_of(const test::Cloud& cloud) {
  float extent = 0.0F;
  for (const auto* column : {&cloud.x, &cloud.y, &cloud.z}) {
    for (const float value : *column) extent = std::max(extent, std::abs(value));
  }
  return extent;
}

class Gather : public test::EverySimdPath {};
class OutermostMembers : public test::EverySimdPath {};
class Depths : public test::EverySimdPath {};
class DropDeep : public test::EverySimdPath {};
class MarkNear : public test::EverySimdPath {};

TEST_P(Gather, TakesTheMembersOfTheReferencesSliceInOrder) {
  test::Random random(1);
  for (const test::Distribution& distribution : test::distributions()) {
    const test::Cloud cloud = distribution.make(random);
    const PaddedCloud padded(cloud);
    const std::vector<std::uint8_t> marks(cloud.size() + kKernelPadding);
    const float extent = extent_of(cloud);
    Columns columns(cloud.size());
    for (std::uint32_t i = 0; i < 11; ++i) {
      const SlicingPlane plane = slicing_plane(i, 11);
      const std::array all{ShellIndex::Range{0, static_cast<std::uint32_t>(cloud.size())}};
      const std::size_t count =
          gather(padded.view(), marks, all, plane, 0.25, extent, columns.view());
      const std::vector<std::size_t> expected = reference::cut(cloud.view(), plane, 0.25);
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), columns.position.begin(),
                             columns.position.begin() + static_cast<std::ptrdiff_t>(count)))
          << distribution.name;
      for (std::size_t k = 0; k < count; ++k) {
        ASSERT_EQ(columns.z[k], cloud.z[expected[k]]);
        ASSERT_NEAR(static_cast<double>(columns.u[k]),
                    plane.along(cloud.x[expected[k]], cloud.y[expected[k]]),
                    2.6e-7 * static_cast<double>(extent));
      }
    }
  }
}

TEST_P(Gather, DecidesExactlyWhereFloatCannot) {
  // On both sides of |v| = d by one step of float, at every lane.
  const SlicingPlane plane = slicing_plane(1, 7);
  test::Random random(4);
  test::Cloud cloud;
  for (int i = 0; i < 500; ++i) {
    const double u = random.uniform(-90, 90);
    const double v = random.index(2) == 0 ? 0.05 : -0.05;
    auto x = static_cast<float>(u * plane.cos_theta - v * plane.sin_theta);
    if (random.index(2) == 0) x = std::nextafter(x, 1000.0F);
    cloud.add(static_cast<double>(x), u * plane.sin_theta + v * plane.cos_theta, 0.0);
  }
  const PaddedCloud padded(cloud);
  const std::vector<std::uint8_t> marks(cloud.size() + kKernelPadding);
  Columns columns(cloud.size());
  const std::array all{ShellIndex::Range{0, static_cast<std::uint32_t>(cloud.size())}};
  const std::size_t count =
      gather(padded.view(), marks, all, plane, 0.05, extent_of(cloud), columns.view());
  const std::vector<std::size_t> expected = reference::cut(cloud.view(), plane, 0.05);
  ASSERT_GT(expected.size(), 100U);
  ASSERT_LT(expected.size(), 400U);
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), columns.position.begin(),
                         columns.position.begin() + static_cast<std::ptrdiff_t>(count)));
}

TEST_P(Gather, TakesRangesInTurnAndTellsWhatIsMarked) {
  test::Cloud cloud;
  for (int i = 0; i < 5; ++i) cloud.add(i, 0, 0);
  const PaddedCloud padded(cloud);
  std::vector<std::uint8_t> marks(5 + kKernelPadding);
  marks[4] = 1;
  Columns columns(5);
  const std::array<ShellIndex::Range, 2> ranges{{{3, 5}, {1, 2}}};
  ASSERT_EQ(gather(padded.view(), marks, ranges, {}, 0.25, 5.0F, columns.view()), 3U);
  EXPECT_EQ(columns.position[0], 3U);
  EXPECT_EQ(columns.position[1], 4U | kMarked);
  EXPECT_EQ(columns.position[2], 1U);
}

TEST_P(OutermostMembers, AreMembersAndNearlyOutermostAllRound) {
  test::Random random(2);
  for (const std::size_t count : {1U, 2U, 31U, 32U, 33U, 2047U, 2048U, 50'000U}) {
    for (const Directions directions : {Directions::coarse, Directions::fine}) {
      Columns columns = random_columns(count, random);
      const Extremes found = extremes(columns.view(), count, directions);
      ASSERT_LT(std::ranges::max(found), count);
      // Counter-clockwise from +u: the fourth and the twelfth are about +z and −z.
      const auto greatest = [&](const std::vector<float>& values) {
        return *std::max_element(values.begin(),
                                 values.begin() + static_cast<std::ptrdiff_t>(count));
      };
      const float slack = directions == Directions::coarse ? 0.01F : 0.15F;
      EXPECT_GE(columns.u[found[0]], greatest(columns.u) - slack) << count;
      EXPECT_GE(columns.z[found[4]], greatest(columns.z) - slack) << count;
      for (float& u : columns.u) u = -u;
      for (float& z : columns.z) z = -z;
      EXPECT_GE(columns.u[found[8]], greatest(columns.u) - slack) << count;
      EXPECT_GE(columns.z[found[12]], greatest(columns.z) - slack) << count;
    }
  }
}

// The corners of a regular polygon of radius 1 about the origin, counter-clockwise.
[[nodiscard]] std::vector<HullPoint> regular_polygon(std::size_t corners) {
  std::vector<HullPoint> polygon;
  for (std::size_t k = 0; k < corners; ++k) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(corners);
    polygon.push_back({{std::cos(angle), std::sin(angle)}, 0});
  }
  return polygon;
}

struct Edges {
  explicit Edges(std::size_t corners)
      : polygon(regular_polygon(corners)),
        normal_u(corners + kKernelPadding),
        normal_z(corners + kKernelPadding),
        offset(corners + kKernelPadding),
        columns{normal_u.data(), normal_z.data(), offset.data()} {
    set_edges(polygon, columns);
  }
  // Distance from the nearest line, in double from the corners.
  [[nodiscard]] double depth(float u, float z) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const HullPoint& from = polygon[k];
      const HullPoint& to = polygon[(k + 1) % polygon.size()];
      const double edge_u = to.u - from.u;
      const double edge_z = to.z - from.z;
      const double cross =
          edge_u * (static_cast<double>(z) - from.z) - edge_z * (static_cast<double>(u) - from.u);
      nearest = std::min(nearest, cross / std::hypot(edge_u, edge_z));
    }
    return nearest;
  }
  std::vector<HullPoint> polygon;
  std::vector<float> normal_u, normal_z, offset;
  EdgeColumns columns;
};

constexpr std::array<std::size_t, 7> kCounts{1, 15, 16, 63, 64, 65, 300};

TEST_P(Depths, AreDistancesFromTheNearestLineAndShallowMembersAreCopied) {
  test::Random random(3);
  for (const std::size_t corners : {3U, 4U, 17U}) {
    const Edges edges(corners);
    for (const std::size_t count : kCounts) {
      Columns columns = random_columns(count, random);
      Columns shallow(count);
      std::vector<float> depth(count + kKernelPadding);
      const std::size_t found =
          depths(edges.columns, columns.view(), count, 0.25F, depth.data(), shallow.view());
      std::size_t next = 0;
      for (std::size_t k = 0; k < count; ++k) {
        ASSERT_NEAR(static_cast<double>(depth[k]), edges.depth(columns.u[k], columns.z[k]), 2e-6);
        if (depth[k] > 0.25F) continue;
        ASSERT_LT(next, found);
        ASSERT_EQ(shallow.u[next], columns.u[k]);
        ASSERT_EQ(shallow.z[next], columns.z[k]);
        ASSERT_EQ(shallow.position[next], columns.position[k] & ~kMarked);
        ++next;
      }
      ASSERT_EQ(next, found);
    }
  }
}

TEST_P(Depths, MayReplaceTheMembers) {
  test::Random random(5);
  const Edges edges(5);
  Columns columns = random_columns(300, random);
  Columns in_place = columns;
  Columns apart(300);
  std::vector<float> depth(300 + kKernelPadding);
  const std::size_t found =
      depths(edges.columns, columns.view(), 300, 0.1F, depth.data(), apart.view());
  ASSERT_EQ(depths(edges.columns, in_place.view(), 300, 0.1F, depth.data(), in_place.view()),
            found);
  for (std::size_t k = 0; k < found; ++k) ASSERT_EQ(in_place.position[k], apart.position[k]);
}

TEST_P(DropDeep, LeavesTheShallowOnesThatAreNotMarked) {
  test::Random random(6);
  for (const std::size_t count : kCounts) {
    Columns columns = random_columns(count, random);
    const Columns before = columns;
    std::vector<float> depth(count + kKernelPadding, -1.0F);
    for (std::size_t k = 0; k < count; ++k) depth[k] = static_cast<float>(random.uniform(-1, 1));
    const std::size_t left = drop_deep(depth.data(), 0.5F, columns.view(), count);
    std::size_t next = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (depth[k] > 0.5F || (before.position[k] & kMarked) != 0) continue;
      ASSERT_LT(next, left);
      ASSERT_EQ(columns.u[next], before.u[k]);
      ASSERT_EQ(columns.z[next], before.z[k]);
      ASSERT_EQ(columns.position[next], before.position[k]);
      ++next;
    }
    ASSERT_EQ(next, left);
  }
}

TEST_P(MarkNear, MarksWhatIsSurelyNearAndLeavesWhatIsDoubtful) {
  test::Random random(7);
  const Edges edges(9);
  for (const std::size_t count : kCounts) {
    Columns columns = random_columns(count, random);
    const Columns before = columns;
    std::vector<std::uint8_t> marks(count);
    const std::size_t doubtful = mark_near(edges.columns, columns.view(), count, 0.3F, 0.1F, marks);
    std::size_t next = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double depth = edges.depth(before.u[k], before.z[k]);
      if (std::abs(std::abs(depth - 0.3) - 0.1) < 1e-5) GTEST_FAIL() << "another seed, please";
      ASSERT_EQ(marks[k], depth < 0.2 ? 1 : 0);
      if (depth < 0.2 || depth > 0.4) continue;
      ASSERT_LT(next, doubtful);
      ASSERT_EQ(columns.position[next++], before.position[k] & ~kMarked);
    }
    ASSERT_EQ(next, doubtful);
  }
}

CONVEXCUT_ON_EVERY_SIMD_PATH(Gather);
CONVEXCUT_ON_EVERY_SIMD_PATH(OutermostMembers);
CONVEXCUT_ON_EVERY_SIMD_PATH(Depths);
CONVEXCUT_ON_EVERY_SIMD_PATH(DropDeep);
CONVEXCUT_ON_EVERY_SIMD_PATH(MarkNear);

}  // namespace
}  // namespace convexcut
