// SPDX-License-Identifier: Apache-2.0
//
// The kernels on every instruction set of this processor. The error of u is tried on clouds, not
// proved: the design note has the bound.
#include "core/convex_cut/slice_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/reference.hpp"
#include "tests/core/convex_cut/clouds.hpp"
#include "tests/core/convex_cut/every_simd_path.hpp"
#include "tests/core/convex_cut/slice_columns.hpp"

namespace convexcut {
namespace {

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

TEST_P(Gather, TakesTheMembersOfTheReferencesSliceInOrder) {
  test::Random random(1);
  for (const test::Distribution& distribution : test::distributions()) {
    const test::Cloud cloud = distribution.make(random);
    const PaddedCloud padded(cloud);
    const std::vector<std::uint8_t> marks(cloud.size() + kKernelPadding);
    const float extent = extent_of(cloud);
    test::Columns columns(cloud.size());
    for (std::uint32_t i = 0; i < 11; ++i) {
      const SlicingPlane plane = slicing_plane(i, 11);
      const std::array all{
          ShellIndex::Candidates{{0, static_cast<std::uint32_t>(cloud.size())}, -9.0F, 9.0F}};
      Stretch stretch;
      const std::size_t count =
          gather(padded.view(), marks, all, plane, 0.25, extent, columns.view(), &stretch);
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
  test::Columns columns(cloud.size());
  const std::array all{
      ShellIndex::Candidates{{0, static_cast<std::uint32_t>(cloud.size())}, -99.0F, 99.0F}};
  Stretch stretch;
  const std::size_t count =
      gather(padded.view(), marks, all, plane, 0.05, extent_of(cloud), columns.view(), &stretch);
  const std::vector<std::size_t> expected = reference::cut(cloud.view(), plane, 0.05);
  ASSERT_GT(expected.size(), 100U);
  ASSERT_LT(expected.size(), 400U);
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), columns.position.begin(),
                         columns.position.begin() + static_cast<std::ptrdiff_t>(count)));
}

TEST_P(Gather, MakesAStretchOfEachRangeAndTellsWhatIsMarked) {
  test::Cloud cloud;
  for (int i = 0; i < 5; ++i) cloud.add(i, 0, 0);
  const PaddedCloud padded(cloud);
  std::vector<std::uint8_t> marks(5 + kKernelPadding);
  marks[4] = 1;
  test::Columns columns(5);
  const std::array<ShellIndex::Candidates, 2> ranges{{{{3, 5}, 3.0F, 4.0F}, {{1, 2}, 1.0F, 1.0F}}};
  std::array<Stretch, 2> stretches;
  ASSERT_EQ(gather(padded.view(), marks, ranges, {}, 0.25, 5.0F, columns.view(), stretches.data()),
            3U);
  EXPECT_EQ(columns.position[0], 3U);
  EXPECT_EQ(columns.position[1], 4U | kMarked);
  EXPECT_EQ(columns.position[2], 1U);
  EXPECT_EQ(stretches[0].begin, 0U);
  EXPECT_EQ(stretches[0].end, 2U);
  EXPECT_EQ(stretches[0].least_u_m, 3.0F);
  EXPECT_EQ(stretches[0].most_u_m, 4.0F);
  EXPECT_EQ(stretches[1].begin, 2U);
  EXPECT_EQ(stretches[1].end, 3U);
}

TEST_P(OutermostMembers, AreMembersAndNearlyOutermostAllRound) {
  test::Random random(2);
  for (const std::size_t count : {1U, 2U, 31U, 32U, 33U, 2047U, 2048U, 50'000U}) {
    test::Columns columns = test::random_columns(count, random);
    const Extremes found = extremes(columns.view(), count);
    ASSERT_LT(std::ranges::max(found), count);
    // Counter-clockwise from +u: the fourth and the twelfth are about +z and −z.
    const auto greatest = [&](const std::vector<float>& values) {
      return *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
    };
    constexpr float kSlack = 0.25F;
    EXPECT_GE(columns.u[found[0]], greatest(columns.u) - kSlack) << count;
    EXPECT_GE(columns.z[found[4]], greatest(columns.z) - kSlack) << count;
    for (float& u : columns.u) u = -u;
    for (float& z : columns.z) z = -z;
    EXPECT_GE(columns.u[found[8]], greatest(columns.u) - kSlack) << count;
    EXPECT_GE(columns.z[found[12]], greatest(columns.z) - kSlack) << count;
  }
}

CONVEXCUT_ON_EVERY_SIMD_PATH(Gather);
CONVEXCUT_ON_EVERY_SIMD_PATH(OutermostMembers);

}  // namespace
}  // namespace convexcut
