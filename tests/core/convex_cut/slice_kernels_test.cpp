// SPDX-License-Identifier: Apache-2.0
//
// The error of depth_within() is tried on clouds, not proved: the design note has the bound.
#include "core/convex_cut/slice_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/reference.hpp"
#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut {
namespace {

// The columns of one slice, with the room that the kernels ask for.
struct Columns {
  explicit Columns(std::size_t count)
      : u(count + kKernelBlock), z(count + kKernelBlock), position(count + kKernelBlock) {}
  [[nodiscard]] SliceColumns view() { return {u.data(), z.data(), position.data()}; }
  std::vector<float> u, z;
  std::vector<std::uint32_t> position;
};

TEST(Gather, TakesTheMembersOfTheReferencesSliceInOrder) {
  test::Random random(1);
  for (const test::Distribution& distribution : test::distributions()) {
    const test::Cloud cloud = distribution.make(random);
    Columns columns(cloud.size());
    for (std::uint32_t i = 0; i < 11; ++i) {
      const SlicingPlane plane = slicing_plane(i, 11);
      const auto all = ShellIndex::Range{0, static_cast<std::uint32_t>(cloud.size())};
      const std::size_t count = gather(cloud.view(), all, plane, 0.25, columns.view(), 0);
      const std::vector<std::size_t> expected = reference::cut(cloud.view(), plane, 0.25);
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), columns.position.begin(),
                             columns.position.begin() + static_cast<std::ptrdiff_t>(count)))
          << distribution.name;
      for (std::size_t k = 0; k < count; ++k) {
        ASSERT_EQ(columns.z[k], cloud.z[expected[k]]);
        ASSERT_EQ(columns.u[k],
                  static_cast<float>(plane.along(cloud.x[expected[k]], cloud.y[expected[k]])));
      }
    }
  }
}

TEST(Gather, AppendsToWhatIsThere) {
  test::Cloud cloud;
  for (int i = 0; i < 5; ++i) cloud.add(i, 0, 0);
  Columns columns(5);
  const std::size_t count = gather(cloud.view(), {3, 5}, {}, 0.25, columns.view(), 0);
  EXPECT_EQ(gather(cloud.view(), {1, 2}, {}, 0.25, columns.view(), count), 3U);
  EXPECT_EQ(columns.position[2], 1U);
}

TEST(Extremes, AreMembersAndNearlyOutermost) {
  test::Random random(2);
  // 5000 exceeds the indices that fit beside a value: members are then found by groups.
  for (const std::size_t count : {1U, 2U, 31U, 32U, 33U, 2047U, 2048U, 5000U}) {
    Columns columns(count);
    for (std::size_t k = 0; k < count; ++k) {
      columns.u[k] = static_cast<float>(random.uniform(-5, 5));
      columns.z[k] = static_cast<float>(random.uniform(-1, 2));
    }
    const auto found = extremes(columns.view(), count);
    ASSERT_LT(std::ranges::max(found), count);
    const auto greatest = [&](const std::vector<float>& values) {
      return *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
    };
    const auto found_greatest = [&](const std::vector<float>& values) {
      float most = -std::numeric_limits<float>::max();
      for (const std::size_t k : found) most = std::max(most, values[k]);
      return most;
    };
    EXPECT_NEAR(found_greatest(columns.u), greatest(columns.u), 5e-3) << count;
    EXPECT_NEAR(found_greatest(columns.z), greatest(columns.z), 5e-3) << count;
  }
}

// Half-planes of a regular polygon of radius 1 about the origin.
struct Polygon {
  explicit Polygon(std::size_t edges) {
    for (std::size_t k = 0; k < edges; ++k) {
      const double angle =
          2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(edges);
      normal_u.push_back(static_cast<float>(-std::cos(angle)));
      normal_z.push_back(static_cast<float>(-std::sin(angle)));
      offset.push_back(-1.0F);
    }
  }
  [[nodiscard]] EdgeColumns view() { return {normal_u.data(), normal_z.data(), offset.data()}; }
  std::vector<float> normal_u, normal_z, offset;
};

TEST(DepthWithin, IsTheDistanceFromTheNearestLineForEveryCount) {
  test::Random random(3);
  for (const std::size_t edge_count : {1U, 3U, 17U}) {
    Polygon polygon(edge_count);
    for (const std::size_t count : {1U, 31U, 32U, 33U, 100U}) {
      Columns columns(count);
      std::vector<float> depth(count + kKernelBlock);
      for (std::size_t k = 0; k < count; ++k) {
        columns.u[k] = static_cast<float>(random.uniform(-2, 2));
        columns.z[k] = static_cast<float>(random.uniform(-2, 2));
      }
      depth_within(polygon.view(), edge_count, columns.view(), count, depth.data());
      for (std::size_t k = 0; k < count; ++k) {
        double expected = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < edge_count; ++i) {
          expected = std::min(
              expected,
              static_cast<double>(polygon.normal_u[i]) * static_cast<double>(columns.u[k]) +
                  static_cast<double>(polygon.normal_z[i]) * static_cast<double>(columns.z[k]) +
                  1.0);
        }
        ASSERT_NEAR(static_cast<double>(depth[k]), expected, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace convexcut
