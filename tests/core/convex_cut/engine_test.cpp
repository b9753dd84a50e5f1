// SPDX-License-Identifier: Apache-2.0
//
// What the engine refuses, and how. Its labels are engine_oracle_test's matter.
#include "core/convex_cut/engine.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut {
namespace {

[[nodiscard]] test::Cloud hundred_points() {
  test::Random random(1);
  return test::furnished_room(random, 100);
}

// The status, having made sure that a refusal writes no label.
[[nodiscard]] CutStatus status_of(const CloudView& cloud, std::size_t label_count) {
  ConvexCutEngine engine({}, 100, 1);
  std::vector<Label> labels(label_count, Label::structure);
  const CutStatus status = engine.label(cloud, labels);
  if (status != CutStatus::ok) {
    EXPECT_EQ(labels, std::vector<Label>(label_count, Label::structure));
  }
  return status;
}

TEST(ConvexCutEngine, RefusesCoordinatesThatAreNoMeasurement) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const float beyond = std::nextafter(kMaxCoordinateM, kInfinity);
  for (const float bad : {kNaN, -kNaN, kInfinity, -kInfinity, beyond, -beyond}) {
    for (const auto column : {&test::Cloud::x, &test::Cloud::y, &test::Cloud::z}) {
      for (const std::size_t k : {0U, 50U, 99U}) {
        test::Cloud cloud = hundred_points();
        (cloud.*column)[k] = bad;
        EXPECT_EQ(status_of(cloud.view(), 100), CutStatus::coordinate_out_of_range) << bad;
      }
    }
  }
}

TEST(ConvexCutEngine, TakesTheGreatestCoordinate) {
  test::Cloud cloud = hundred_points();
  cloud.x[3] = kMaxCoordinateM;
  cloud.z[7] = -kMaxCoordinateM;
  EXPECT_EQ(status_of(cloud.view(), 100), CutStatus::ok);
}

TEST(ConvexCutEngine, RefusesMorePointsThanItWasBuiltFor) {
  test::Cloud cloud = hundred_points();
  cloud.add(1, 1, 1);
  EXPECT_EQ(status_of(cloud.view(), 101), CutStatus::too_many_points);
}

TEST(ConvexCutEngine, RefusesColumnsOfDifferentLengths) {
  test::Cloud cloud = hundred_points();
  EXPECT_EQ(status_of(cloud.view(), 99), CutStatus::size_mismatch);
  cloud.z.pop_back();
  EXPECT_EQ(status_of(cloud.view(), 100), CutStatus::size_mismatch);
}

TEST(ConvexCutEngine, EveryOtherPlaneIsConvexCutWithHalfThePlanes) {
  test::Random random(2);
  const test::Cloud cloud = test::furnished_room(random, 5'000);
  for (const std::uint32_t stride : {2U, 4U, 9U}) {
    ConvexCutEngine all({.planes = 360}, 5'000, 2);
    ConvexCutEngine fewer({.planes = 360 / stride}, 5'000, 1);
    std::vector<Label> found(5'000);
    std::vector<Label> expected(5'000);
    ASSERT_EQ(all.label(cloud.view(), found, stride), CutStatus::ok);
    ASSERT_EQ(fewer.label(cloud.view(), expected), CutStatus::ok);
    EXPECT_EQ(found, expected) << stride;
    // And the next cloud is cut by all again.
    std::vector<Label> whole(5'000);
    ASSERT_EQ(all.label(cloud.view(), whole), CutStatus::ok);
    EXPECT_NE(whole, expected);
  }
}

TEST(ConvexCutEngine, AStrideThatDoesNotDivideThePlanesTakesTheLastOne) {
  test::Random random(3);
  const test::Cloud cloud = test::furnished_room(random, 1'000);
  ConvexCutEngine engine({.planes = 5}, 1'000, 1);
  std::vector<Label> every_fifth(1'000);
  std::vector<Label> every_fourth(1'000);  // planes 0 and 4
  ASSERT_EQ(engine.label(cloud.view(), every_fifth, 5), CutStatus::ok);
  ASSERT_EQ(engine.label(cloud.view(), every_fourth, 4), CutStatus::ok);
  EXPECT_GT(std::count(every_fourth.begin(), every_fourth.end(), Label::structure),
            std::count(every_fifth.begin(), every_fifth.end(), Label::structure));
}

TEST(ConvexCutEngine, TakesAnEmptyCloud) {
  EXPECT_EQ(status_of({}, 0), CutStatus::ok);
  ConvexCutEngine none({}, 0, 2);
  EXPECT_EQ(none.label({}, {}), CutStatus::ok);
}

TEST(ConvexCutEngine, WorksOnAfterARefusal) {
  test::Cloud cloud = hundred_points();
  ConvexCutEngine engine({}, 100, 2);
  std::vector<Label> before(100);
  std::vector<Label> after(100);
  ASSERT_EQ(engine.label(cloud.view(), before), CutStatus::ok);
  const float good = cloud.x[5];
  cloud.x[5] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_EQ(engine.label(cloud.view(), after), CutStatus::coordinate_out_of_range);
  cloud.x[5] = good;
  ASSERT_EQ(engine.label(cloud.view(), after), CutStatus::ok);
  EXPECT_EQ(after, before);
}

TEST(ConvexCutEngine, IsNotBuiltWithNonsense) {
  EXPECT_THROW(ConvexCutEngine({.planes = 0}, 100, 1), std::invalid_argument);
  EXPECT_THROW(ConvexCutEngine({.half_width_m = -1.0}, 100, 1), std::invalid_argument);
  EXPECT_THROW(ConvexCutEngine({}, std::size_t{1} << 40U, 1), std::invalid_argument);
}

}  // namespace
}  // namespace convexcut
