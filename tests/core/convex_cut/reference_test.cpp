// SPDX-License-Identifier: Apache-2.0
//
// The reference on clouds that can be followed by hand. Does not prove that the paper's method
// finds structure: only that these are its labels.
#include "core/convex_cut/reference.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut {
namespace {

constexpr Label kStructure = Label::structure;
constexpr Label kOther = Label::other;

[[nodiscard]] std::vector<Label> labels_of(const ConvexCutParameters& parameters,
                                           const test::Cloud& cloud) {
  std::vector<Label> labels(cloud.size(), kOther);
  EXPECT_EQ(reference::label(parameters, cloud.view(), labels), CutStatus::ok);
  return labels;
}

// A rectangle of 8 × 2 m in the plane y = 0.
[[nodiscard]] test::Cloud rectangle() {
  test::Cloud cloud;
  cloud.add(-4, 0, -1);
  cloud.add(4, 0, -1);
  cloud.add(4, 0, 1);
  cloud.add(-4, 0, 1);
  return cloud;
}

constexpr ConvexCutParameters kOnePlane{.planes = 1, .half_width_m = 0.5, .hull_distance_m = 0.25};

TEST(Reference, KeepsWhatIsNearTheHullAndLeavesTheRest) {
  test::Cloud cloud = rectangle();
  cloud.add(3.8, 0, 0);  // 0.2 m from the right side
  cloud.add(3.5, 0, 0);  // 0.5 m
  cloud.add(0, 0, 0);
  EXPECT_EQ(labels_of(kOnePlane, cloud),
            (std::vector<Label>{kStructure, kStructure, kStructure, kStructure, kStructure, kOther,
                                kOther}));
}

TEST(Reference, APointExactlyAtTheHullDistanceIsKept) {
  test::Cloud cloud = rectangle();
  cloud.add(3.75, 0, 0);
  EXPECT_EQ(labels_of(kOnePlane, cloud).back(), kStructure);
}

TEST(Reference, APointExactlyAtTheHalfWidthIsNotInTheSlice) {
  EXPECT_EQ(labels_of(kOnePlane,
                      [] {
                        test::Cloud cloud = rectangle();
                        cloud.add(0, 0.5, 1);
                        return cloud;
                      }())
                .back(),
            kOther);
}

TEST(Reference, ASliceOfFewerThanThreePointsKeepsThem) {
  test::Cloud cloud;
  cloud.add(1, 0, 0);
  cloud.add(2, 0, 1);
  EXPECT_EQ(labels_of(kOnePlane, cloud), (std::vector<Label>{kStructure, kStructure}));
}

TEST(Reference, ASliceOfCollinearPointsKeepsThem) {
  test::Cloud cloud;
  for (int i = 0; i < 5; ++i) cloud.add(i, 0, 2 * i);
  EXPECT_EQ(labels_of(kOnePlane, cloud), std::vector<Label>(5, kStructure));
}

TEST(Reference, APointIsStructureWhenAnySliceKeepsIt) {
  // The middle of the rectangle is far from the hull of plane 0, but alone in plane 1.
  test::Cloud cloud = rectangle();
  cloud.add(0, 0, 0);
  EXPECT_EQ(labels_of(kOnePlane, cloud).back(), kOther);
  EXPECT_EQ(labels_of({.planes = 2, .half_width_m = 0.5, .hull_distance_m = 0.25}, cloud).back(),
            kStructure);
}

TEST(Reference, APointInNoSliceIsOther) {
  test::Cloud cloud;
  cloud.add(0, 3, 0);
  EXPECT_EQ(labels_of(kOnePlane, cloud).back(), kOther);
}

TEST(Reference, RefusesNotANumberAndWritesNoLabel) {
  test::Cloud cloud = rectangle();
  cloud.z[2] = std::numeric_limits<float>::quiet_NaN();
  std::vector<Label> labels(4, kStructure);
  EXPECT_EQ(reference::label(kOnePlane, cloud.view(), labels), CutStatus::coordinate_out_of_range);
  EXPECT_EQ(labels, std::vector<Label>(4, kStructure));
}

TEST(ConvexCutParameters, DefaultsAreValidAndNonsenseIsNot) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_valid({}));
  EXPECT_FALSE(is_valid({.planes = 0}));
  EXPECT_FALSE(is_valid({.half_width_m = 0.0}));
  EXPECT_FALSE(is_valid({.half_width_m = kNaN}));
  EXPECT_FALSE(is_valid({.hull_distance_m = -0.01}));
  EXPECT_FALSE(is_valid({.hull_distance_m = kNaN}));
  EXPECT_TRUE(is_valid({.hull_distance_m = 0.0}));
}

}  // namespace
}  // namespace convexcut
