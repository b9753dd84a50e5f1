// SPDX-License-Identifier: Apache-2.0
//
// What the method promises of any cloud, tried on furnished rooms. The labels that a property talks
// about are the engine's; slices and hulls are the reference's.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/engine.hpp"
#include "core/convex_cut/reference.hpp"
#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut {
namespace {

constexpr ConvexCutParameters kParameters{.planes = 36};

[[nodiscard]] std::vector<Label> labels_of(const test::Cloud& cloud,
                                           const ConvexCutParameters& parameters = kParameters) {
  ConvexCutEngine engine(parameters, cloud.size(), 2);
  std::vector<Label> labels(cloud.size());
  EXPECT_EQ(engine.label(cloud.view(), labels), CutStatus::ok);
  return labels;
}

[[nodiscard]] test::Cloud room(std::uint64_t seed) {
  test::Random random(seed);
  return test::furnished_room(random, 3000);
}

TEST(ConvexCut, KeepsTheVerticesOfEveryHull) {
  const test::Cloud cloud = room(1);
  const std::vector<Label> labels = labels_of(cloud);
  std::size_t vertices = 0;
  for (std::uint32_t i = 0; i < kParameters.planes; ++i) {
    const SlicingPlane plane = slicing_plane(i, kParameters.planes);
    const auto slice = reference::cut(cloud.view(), plane, kParameters.half_width_m);
    const auto points = reference::project(cloud.view(), plane, slice);
    const auto hull = reference::hull(points);
    for (std::size_t k = 0; k < slice.size(); ++k) {
      if (std::ranges::find(hull, points[k]) == hull.end()) continue;
      ++vertices;
      EXPECT_EQ(labels[slice[k]], Label::structure);
    }
  }
  EXPECT_GT(vertices, 3 * kParameters.planes);
}

TEST(ConvexCut, KeptPointsHaveTheHullOfAllPointsInEverySlice) {
  const test::Cloud cloud = room(2);
  const std::vector<Label> labels = labels_of(cloud);
  test::Cloud kept;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    if (labels[k] == Label::structure) kept.add_from(cloud, k);
  }
  ASSERT_LT(kept.size(), cloud.size());
  for (std::uint32_t i = 0; i < kParameters.planes; ++i) {
    const SlicingPlane plane = slicing_plane(i, kParameters.planes);
    const auto hull_of = [&](const test::Cloud& any) {
      return reference::hull(reference::project(
          any.view(), plane, reference::cut(any.view(), plane, kParameters.half_width_m)));
    };
    EXPECT_EQ(hull_of(kept), hull_of(cloud)) << i;
  }
}

TEST(ConvexCut, ReorderingThePointsReordersTheLabels) {
  const test::Cloud cloud = room(3);
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  test::Random random(4);
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random.index(k)]);
  test::Cloud shuffled;
  for (const std::size_t k : order) shuffled.add_from(cloud, k);
  const std::vector<Label> labels = labels_of(cloud);
  const std::vector<Label> shuffled_labels = labels_of(shuffled);
  for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(shuffled_labels[k], labels[order[k]]);
}

TEST(ConvexCut, MovingTheCloudUpLeavesTheLabels) {
  test::Cloud cloud = room(5);
  for (float& z : cloud.z) z = std::round(z * 1024.0F) / 1024.0F;  // so that sums are exact
  test::Cloud moved = cloud;
  for (float& z : moved.z) z += 37.0F;
  EXPECT_EQ(labels_of(moved), labels_of(cloud));
}

TEST(ConvexCut, TurningTheCloudHalfwayLeavesTheLabels) {
  const test::Cloud cloud = room(6);
  test::Cloud turned = cloud;
  for (float& x : turned.x) x = -x;
  for (float& y : turned.y) y = -y;
  EXPECT_EQ(labels_of(turned), labels_of(cloud));
}

TEST(ConvexCut, DoublingEveryLengthLeavesTheLabels) {
  const test::Cloud cloud = room(7);
  test::Cloud doubled = cloud;
  for (auto* column : {&doubled.x, &doubled.y, &doubled.z}) {
    for (float& value : *column) value *= 2.0F;
  }
  EXPECT_EQ(labels_of(doubled, {kParameters.planes, 2 * kParameters.half_width_m,
                                2 * kParameters.hull_distance_m}),
            labels_of(cloud));
}

TEST(ConvexCut, AGreaterHullDistanceKeepsAllThatASmallerOneKeeps) {
  const test::Cloud cloud = room(8);
  std::vector<Label> fewer = labels_of(cloud, {36, 0.05, 0.0});
  for (const double e : {0.01, 0.04, 0.08, 0.3, 5.0}) {
    const std::vector<Label> more = labels_of(cloud, {36, 0.05, e});
    for (std::size_t k = 0; k < cloud.size(); ++k) {
      EXPECT_GE(more[k], fewer[k]) << k;
    }
    EXPECT_GT(std::ranges::count(more, Label::structure),
              std::ranges::count(fewer, Label::structure));
    fewer = more;
  }
}

// Turning a cloud rounds its coordinates, by less than 1e-6 m here. A point may then change its
// label if any decision of a slice that it is in, or may come to be in, is that close: |v| = d
// decides who makes the hull, its distance from the hull who is near it. Everywhere else, hulls
// move by as little as their vertices do.
class NearlyDecided {
 public:
  NearlyDecided(const test::Cloud& cloud, const ConvexCutParameters& parameters)
      : touched_(cloud.size(), false) {
    constexpr double kBand = 1e-5;
    for (std::uint32_t i = 0; i < parameters.planes; ++i) {
      const SlicingPlane plane = slicing_plane(i, parameters.planes);
      const auto wide = reference::cut(cloud.view(), plane, parameters.half_width_m + kBand);
      const auto slice = reference::cut(cloud.view(), plane, parameters.half_width_m - kBand);
      bool close = wide.size() != slice.size();
      const auto points = reference::project(cloud.view(), plane, slice);
      const auto hull = reference::hull(points);
      for (const SlicePoint& point : points) {
        if (hull.size() < 3) break;
        const double distance = std::sqrt(reference::squared_distance_to_boundary(point, hull));
        close = close || std::abs(distance - parameters.hull_distance_m) < kBand;
      }
      if (!close) continue;
      for (const std::size_t k : wide) touched_[k] = true;
    }
  }
  [[nodiscard]] bool contains(std::size_t k) const { return touched_[k]; }

 private:
  std::vector<bool> touched_;
};

TEST(ConvexCut, TurningTheCloudByOnePlaneLeavesTheLabels) {
  const test::Cloud cloud = room(9);
  const double step = std::numbers::pi / kParameters.planes;
  test::Cloud turned;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const auto x = static_cast<double>(cloud.x[k]);
    const auto y = static_cast<double>(cloud.y[k]);
    turned.add(x * std::cos(step) - y * std::sin(step), x * std::sin(step) + y * std::cos(step),
               static_cast<double>(cloud.z[k]));
  }
  const NearlyDecided nearly_decided(cloud, kParameters);
  const std::vector<Label> labels = labels_of(cloud);
  const std::vector<Label> turned_labels = labels_of(turned);
  std::size_t compared = 0;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    if (nearly_decided.contains(k)) continue;
    ++compared;
    EXPECT_EQ(turned_labels[k], labels[k]) << k;
  }
  EXPECT_GT(compared, cloud.size() / 2);
}

}  // namespace
}  // namespace convexcut
