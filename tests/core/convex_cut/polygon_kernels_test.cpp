// SPDX-License-Identifier: Apache-2.0
//
// The kernels on every instruction set of this processor. The errors of depths are tried, not
// proved: the design note has the bounds.
#include "core/convex_cut/polygon_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/convex_cut/clouds.hpp"
#include "tests/core/convex_cut/every_simd_path.hpp"
#include "tests/core/convex_cut/slice_columns.hpp"

namespace convexcut {
namespace {

using test::Columns;
using test::random_columns;

// The edges of a regular polygon of radius 1 about the origin.
struct Edges {
  explicit Edges(std::size_t corners)
      : size(corners), u(corners + 2 + kKernelPadding), z(corners + 2 + kKernelPadding) {
    // In front the last one again, and behind the first one.
    for (std::size_t k = 0; k < corners + 2; ++k) {
      const double angle =
          2.0 * std::numbers::pi * (static_cast<double>(k) - 1.0) / static_cast<double>(corners);
      u[k] = std::cos(angle);
      z[k] = std::sin(angle);
    }
    for (std::vector<float>& column : columns) column.resize(corners + kKernelPadding);
    edges = {{columns[0].data(), columns[1].data(), columns[2].data()},
             columns[3].data(),
             columns[4].data()};
    facing = {columns[5].data(), columns[6].data(), columns[7].data()};
    set_edges(polygon(), edges);
  }
  [[nodiscard]] Polygon polygon() const { return {u.data() + 1, z.data() + 1, size}; }
  // Distance from the line of edge k, in double from the corners.
  [[nodiscard]] double depth(std::size_t k, float at_u, float at_z) const {
    const double edge_u = u[k + 1] - u[k];
    const double edge_z = z[k + 1] - z[k];
    const double cross =
        edge_u * (static_cast<double>(at_z) - z[k]) - edge_z * (static_cast<double>(at_u) - u[k]);
    return cross / std::hypot(edge_u, edge_z);
  }
  // … from the nearest line.
  [[nodiscard]] double depth(float at_u, float at_z) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < size; ++k) nearest = std::min(nearest, depth(k, at_u, at_z));
    return nearest;
  }
  std::size_t size;
  std::vector<double> u, z;
  std::array<std::vector<float>, 8> columns;
  PolygonEdges edges{};
  EdgeColumns facing{};
};

constexpr std::array<std::size_t, 4> kCorners{3, 4, 17, 40};
constexpr std::array<std::size_t, 7> kCounts{1, 15, 16, 63, 64, 65, 300};

// Members in stretches of u that are 0.25 m long, with one that is empty.
[[nodiscard]] std::vector<Stretch> into_stretches(Columns& columns, std::size_t count) {
  std::vector<Stretch> stretches;
  const Columns before = columns;
  std::uint32_t placed = 0;
  for (float from = -2.0F; from < 2.0F; from += 0.25F) {
    Stretch stretch{placed, placed, from, from + 0.25F};
    for (std::size_t k = 0; k < count; ++k) {
      if (before.u[k] < from || before.u[k] >= from + 0.25F) continue;
      columns.u[placed] = before.u[k];
      columns.z[placed] = before.z[k];
      columns.position[placed++] = before.position[k];
    }
    stretch.end = placed;
    stretches.push_back(stretch);
  }
  stretches.push_back({placed, placed, 0.0F, 0.5F});
  return stretches;
}

class SetEdges : public test::EverySimdPath {};
class FindTurns : public test::EverySimdPath {};
class FindShallow : public test::EverySimdPath {};
class DropDeep : public test::EverySimdPath {};
class FarthestOutside : public test::EverySimdPath {};
class MarkNear : public test::EverySimdPath {};

TEST_P(SetEdges, GivesUnitNormalsInwardsAndThePartOfTheAxis) {
  for (const std::size_t corners : kCorners) {
    const Edges tested(corners);
    ASSERT_EQ(tested.edges.count, corners);
    const double leftmost = *std::min_element(
        tested.u.begin(), tested.u.begin() + static_cast<std::ptrdiff_t>(corners));
    const double rightmost = *std::max_element(
        tested.u.begin(), tested.u.begin() + static_cast<std::ptrdiff_t>(corners));
    for (std::size_t k = 0; k < corners; ++k) {
      const auto normal_u = static_cast<double>(tested.edges.normal_u[k]);
      const auto normal_z = static_cast<double>(tested.edges.normal_z[k]);
      EXPECT_NEAR(std::hypot(normal_u, normal_z), 1.0, 1e-6);
      EXPECT_NEAR(-static_cast<double>(tested.edges.offset[k]), tested.depth(k, 0, 0), 1e-6);
      const double from = std::min(tested.u[k], tested.u[k + 1]);
      const double to = std::max(tested.u[k], tested.u[k + 1]);
      if (from - leftmost < 1e-6) {
        EXPECT_EQ(tested.edges.least_u[k], -std::numeric_limits<float>::max());
      } else {
        EXPECT_NEAR(static_cast<double>(tested.edges.least_u[k]), from, 1e-6);
      }
      if (rightmost - to < 1e-6) {
        EXPECT_EQ(tested.edges.most_u[k], std::numeric_limits<float>::max());
      } else {
        EXPECT_NEAR(static_cast<double>(tested.edges.most_u[k]), to, 1e-6);
      }
    }
  }
}

TEST_P(FindTurns, TellsLeftTurnsAndHowOftenTheyGoRound) {
  for (const std::size_t corners : kCorners) {
    Edges tested(corners);
    const Turns turns = find_turns(tested.polygon());
    EXPECT_TRUE(turns.all_left);
    EXPECT_EQ(turns.rounds, 1U);
  }
  for (const std::size_t corner : {0U, 3U, 7U, 8U, 16U}) {
    Edges dented(17);
    for (std::vector<double>* const column : {&dented.u, &dented.z}) {
      (*column)[corner + 1] *= 0.5;
      if (corner == 0) (*column)[18] *= 0.5;
      if (corner == 16) (*column)[0] *= 0.5;
    }
    EXPECT_FALSE(find_turns(dented.polygon()).all_left) << corner;
  }
  // A pentagram turns left everywhere, twice round.
  Edges star(5);
  const Edges pentagon(5);
  for (std::size_t k = 0; k < 7; ++k) {
    star.u[k] = pentagon.u[2 * k % 5 + 1];
    star.z[k] = pentagon.z[2 * k % 5 + 1];
  }
  EXPECT_TRUE(find_turns(star.polygon()).all_left);
  EXPECT_EQ(find_turns(star.polygon()).rounds, 2U);
}

TEST_P(FindTurns, LeavesWhatRoundingCouldTurn) {
  Edges tested(4);
  tested.u = {0.0, 0.1, 0.3, 1.0, 0.0, 0.1};
  tested.z = {1.0, 0.1, 0.3, 1.0, 1.0, 0.1};  // the second is in line but for rounding
  tested.u.resize(6 + kKernelPadding);
  tested.z.resize(6 + kKernelPadding);
  EXPECT_FALSE(find_turns(tested.polygon()).all_left);
}

TEST_P(FindShallow, CopiesThoseThatAreNotDeepFromAnyEdge) {
  test::Random random(3);
  for (const std::size_t corners : kCorners) {
    const Edges tested(corners);
    for (const std::size_t count : kCounts) {
      Columns columns = random_columns(count, random);
      const std::vector<Stretch> stretches = into_stretches(columns, count);
      Columns shallow(count);
      const std::size_t found = find_shallow(tested.edges, tested.facing, columns.view(), stretches,
                                             0.25F, shallow.view());
      std::size_t next = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const double depth = tested.depth(columns.u[k], columns.z[k]);
        if (std::abs(depth - 0.25) < 1e-5) GTEST_FAIL() << "another seed, please";
        if (depth > 0.25) continue;
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

TEST_P(DropDeep, LeavesTheShallowOnesInOrder) {
  test::Random random(6);
  for (const std::size_t corners : kCorners) {
    const Edges tested(corners);
    for (const std::size_t count : kCounts) {
      Columns columns = random_columns(count, random);
      const Columns before = columns;
      const std::size_t left = drop_deep(tested.edges, columns.view(), count, 0.25F);
      std::size_t next = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const double depth = tested.depth(before.u[k], before.z[k]);
        if (std::abs(depth - 0.25) < 1e-5) GTEST_FAIL() << "another seed, please";
        if (depth > 0.25) continue;
        ASSERT_LT(next, left);
        ASSERT_EQ(columns.u[next], before.u[k]);
        ASSERT_EQ(columns.z[next], before.z[k]);
        ASSERT_EQ(columns.position[next], before.position[k]);
        ++next;
      }
      ASSERT_EQ(next, left);
    }
  }
}

TEST_P(FarthestOutside, NamesTheFarthestOfEachEdgeOrNobody) {
  test::Random random(8);
  for (const std::size_t corners : kCorners) {
    const Edges tested(corners);
    for (const std::size_t count : kCounts) {
      const Columns columns = random_columns(count, random);
      Columns copy = columns;
      std::vector<std::uint32_t> found(corners + kKernelPadding);
      farthest_outside(tested.edges, copy.view(), count, 0.125F, found.data());
      for (std::size_t k = 0; k < corners; ++k) {
        double least = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
          least = std::min(least, tested.depth(k, columns.u[i], columns.z[i]));
        }
        if (least > -0.125) {
          ASSERT_EQ(found[k], kNobody);
        } else {
          ASSERT_LT(found[k], count);
          ASSERT_NEAR(tested.depth(k, columns.u[found[k]], columns.z[found[k]]), least, 1e-3);
        }
      }
    }
  }
}

TEST_P(MarkNear, MarksWhatIsSurelyNearAndTellsWhatIsDoubtful) {
  test::Random random(7);
  for (const std::size_t corners : kCorners) {
    const Edges tested(corners);
    for (const std::size_t count : kCounts) {
      Columns columns = random_columns(count, random);
      const std::vector<Stretch> stretches = into_stretches(columns, count);
      std::vector<std::uint8_t> marks(count);
      std::vector<std::uint32_t> near(count + kKernelPadding);
      std::vector<std::uint32_t> doubtful(count + kKernelPadding);
      const std::size_t doubtful_count =
          mark_near(tested.edges, tested.facing, columns.view(), stretches, 0.2F, 0.4F, marks,
                    near.data(), doubtful.data());
      std::size_t next = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const double depth = tested.depth(columns.u[k], columns.z[k]);
        if (std::abs(std::abs(depth - 0.3) - 0.1) < 1e-5) GTEST_FAIL() << "another seed, please";
        const bool unmarked = (columns.position[k] & kMarked) == 0;
        ASSERT_EQ(marks[columns.position[k] & ~kMarked], unmarked && depth < 0.2 ? 1 : 0);
        if (!unmarked || depth < 0.2 || depth > 0.4) continue;
        ASSERT_LT(next, doubtful_count);
        ASSERT_EQ(doubtful[next++], columns.position[k]);
      }
      ASSERT_EQ(next, doubtful_count);
    }
  }
}

CONVEXCUT_ON_EVERY_SIMD_PATH(SetEdges);
CONVEXCUT_ON_EVERY_SIMD_PATH(FindTurns);
CONVEXCUT_ON_EVERY_SIMD_PATH(FindShallow);
CONVEXCUT_ON_EVERY_SIMD_PATH(DropDeep);
CONVEXCUT_ON_EVERY_SIMD_PATH(FarthestOutside);
CONVEXCUT_ON_EVERY_SIMD_PATH(MarkNear);

}  // namespace
}  // namespace convexcut
