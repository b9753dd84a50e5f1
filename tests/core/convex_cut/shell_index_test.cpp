// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that the ranges are short: the benchmark shows that.
#include "core/convex_cut/shell_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/reference.hpp"
#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut {
namespace {

[[nodiscard]] bool is_member(const SlicingPlane& plane, const test::Cloud& cloud, std::size_t k,
                             double half_width_m) {
  return std::abs(plane.offset(cloud.x[k], cloud.y[k])) < half_width_m;
}

void expect_every_point_once(ShellIndex& index, const test::Cloud& cloud) {
  index.build(cloud.view());
  ASSERT_EQ(index.size(), cloud.size());
  std::vector<int> held(cloud.size(), 0);
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const std::uint32_t source = index.source(k);
    ++held.at(source);
    ASSERT_EQ(index.points().x[k], cloud.x[source]);
    ASSERT_EQ(index.points().y[k], cloud.y[source]);
    ASSERT_EQ(index.points().z[k], cloud.z[source]);
  }
  ASSERT_EQ(std::ranges::count(held, 1), std::ssize(held));
  std::vector<int> in_pieces(cloud.size(), 0);
  for (std::size_t k = 0; k < index.pieces().count; ++k) {
    const auto [begin, end] = index.piece(k);
    ASSERT_LE(end - begin, ShellIndex::kChunk);
    for (std::uint32_t position = begin; position < end; ++position) ++in_pieces.at(position);
  }
  ASSERT_EQ(std::ranges::count(in_pieces, 1), std::ssize(in_pieces));
}

TEST(ShellIndex, HoldsEveryPointOnce) {
  test::Random random(1);
  for (const unsigned threads : {1U, 3U}) {
    ShellIndex index(0.05, 10'000, threads);
    for (const test::Distribution& distribution : test::distributions()) {
      expect_every_point_once(index, distribution.make(random));
    }
  }
}

TEST(ShellIndex, HoldsEveryPointOfACloudBeyondTheCaches) {
  test::Random random(3);
  test::Cloud cloud;
  for (int i = 0; i < 530'001; ++i) {
    cloud.add(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-2, 2));
  }
  ShellIndex index(0.05, cloud.size(), 2);
  expect_every_point_once(index, cloud);
}

TEST(ShellIndex, OffersEveryMemberOfEverySliceOnceWithinBounds) {
  test::Random random(2);
  for (const double half_width_m : {1e-6, 1e-4, 0.05, 2.0, 300.0}) {
    ShellIndex index(half_width_m, 10'000, 3);
    for (const test::Distribution& distribution : test::distributions()) {
      const test::Cloud cloud = distribution.make(random);
      index.build(cloud.view());
      for (std::uint32_t i = 0; i < 23; ++i) {
        const SlicingPlane plane = slicing_plane(i, 23);
        std::vector<int> offered(cloud.size(), 0);
        index.for_each_candidate_range(
            ShellIndex::windows(plane), [&](const ShellIndex::Candidates& found) {
              for (std::uint32_t k = found.range.begin; k < found.range.end; ++k) {
                const std::uint32_t source = index.source(k);
                ++offered[source];
                if (!is_member(plane, cloud, source, half_width_m)) continue;
                const double u = plane.along(cloud.x[source], cloud.y[source]);
                ASSERT_GE(u, found.least_u_m);
                ASSERT_LE(u, found.most_u_m);
              }
            });
        for (const std::size_t member : reference::cut(cloud.view(), plane, half_width_m)) {
          ASSERT_EQ(offered[member], 1) << distribution.name << ", plane " << i;
        }
        ASSERT_LE(std::ranges::count_if(offered, [](int times) { return times > 1; }), 0);
      }
    }
  }
}

TEST(ShellIndex, HasThePointsOfTheFirstPartInFront) {
  constexpr int kPoints = 8000;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (const double sense : {-1.0, 1.0}) {
    for (const double start_turns : {0.0, 0.12, 0.4, 0.77}) {
      test::Cloud cloud;
      for (int i = 0; i < kPoints; ++i) {
        const double angle = kTurn * (start_turns + sense * i / kPoints);
        cloud.add(4.0 * std::cos(angle), 4.0 * std::sin(angle), 0.1);
      }
      ShellIndex index(0.05, cloud.size(), 2);
      index.build(cloud.view());
      int in_front = 0;
      int of_first_part = 0;
      for (std::size_t k = 0; k < index.pieces().in_front; ++k) {
        for (std::uint32_t position = index.piece(k).begin; position < index.piece(k).end;
             ++position) {
          ++in_front;
          of_first_part += index.source(position) / (kPoints / 4) % 2 == 0 ? 1 : 0;
        }
      }
      EXPECT_NEAR(in_front, kPoints / 2, kPoints / 20) << sense << " " << start_turns;
      EXPECT_GT(of_first_part, in_front * 8 / 10) << sense << " " << start_turns;
      // The direction a little behind the front bucket is that of a point of the first part.
      const double turns =
          static_cast<double>(index.front_bucket()) / ShellIndex::kBuckets + 0.1 - start_turns;
      const double in_turn = sense * turns - std::floor(sense * turns);
      EXPECT_EQ(static_cast<int>(in_turn * 4.0) % 2, 0) << sense << " " << start_turns;
    }
  }
}

TEST(ShellIndex, OffersPointsOnEitherSideOfTheSeamOfDirections) {
  // 0° and 180° are one direction, at opposite ends of the buckets.
  test::Cloud cloud;
  for (const double x : {-50.0, -3.0, 3.0, 50.0}) {
    for (const double y : {-0.04, -1e-7, -0.0, 0.0, 1e-7, 0.04}) cloud.add(x, y, 0);
  }
  ShellIndex index(0.05, cloud.size(), 2);
  index.build(cloud.view());
  std::size_t offered = 0;
  index.for_each_candidate_range(
      ShellIndex::windows(slicing_plane(0, 360)),
      [&](const ShellIndex::Candidates& found) { offered += found.range.end - found.range.begin; });
  EXPECT_EQ(offered, cloud.size());
}

}  // namespace
}  // namespace convexcut
