// SPDX-License-Identifier: Apache-2.0
//
// Convex Cut of a cloud that comes in pieces: the reference's labels whatever the order and the
// pieces. Does not prove it quick (bench).
#include "core/convex_cut/streaming_cut.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/reference.hpp"
#include "tests/core/convex_cut/clouds.hpp"
#include "tests/core/convex_cut/every_simd_path.hpp"
#include "tests/support/effort.hpp"

namespace convexcut {
namespace {

[[nodiscard]] CloudView first(const test::Cloud& cloud, std::size_t count) {
  const CloudView all = cloud.view();
  return {all.x.first(count), all.y.first(count), all.z.first(count)};
}

// In pieces of up to `largest` points.
void add_in_pieces(StreamingCut& cut, const test::Cloud& cloud, test::Random& random,
                   std::size_t largest) {
  cut.begin();
  for (std::size_t taken = 0; taken < cloud.size();) {
    taken = std::min(taken + random.index(largest + 1), cloud.size());
    ASSERT_EQ(cut.add(first(cloud, taken)), CutStatus::ok);
  }
}

void expect_reference_labels_in_pieces(StreamingCut& cut, const ConvexCutParameters& parameters,
                                       const test::Cloud& cloud, test::Random& random,
                                       std::size_t largest) {
  std::vector<Label> expected(cloud.size());
  ASSERT_EQ(reference::label(parameters, cloud.view(), expected), CutStatus::ok);
  add_in_pieces(cut, cloud, random, largest);
  std::vector<Label> labels(cloud.size(), Label::structure);
  ASSERT_EQ(cut.finish(cloud.view(), labels), CutStatus::ok);
  EXPECT_TRUE(labels == expected);
}

// A lidar in a room with a pillar, as it comes: firing after firing, clockwise, then levelled.
[[nodiscard]] test::Cloud swept_room(double tilt_deg, std::size_t firings, test::Random& random) {
  const double tilt = tilt_deg * std::numbers::pi / 180.0;
  test::Cloud cloud;
  for (std::size_t i = 0; i < firings; ++i) {
    const double azimuth =
        -2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(firings);
    for (int laser = 0; laser < 32; ++laser) {
      if (random.uniform(0.0, 1.0) < 0.1) continue;
      const double elevation = (-30.67 + laser * 4.0 / 3.0) * std::numbers::pi / 180.0;
      const double bx = std::cos(elevation) * std::cos(azimuth);
      const double y = std::cos(elevation) * std::sin(azimuth);
      const double bz = std::sin(elevation);
      const double x = bx * std::cos(tilt) + bz * std::sin(tilt);
      const double z = bz * std::cos(tilt) - bx * std::sin(tilt);
      double range = std::min({4.5 / std::abs(x), 3.5 / std::abs(y), 1.4 / std::abs(z)});
      if (x > 0 && std::abs(y / x - 0.4) < 0.1) range = std::min(range, 2.0 / x);
      range += 0.02 * random.normal();
      cloud.add(range * x, range * y, range * z);
    }
  }
  return cloud;
}

class StreamingOnEverySimdPath : public test::EverySimdPath {};

TEST_P(StreamingOnEverySimdPath, LabelsOfAnyCloudInAnyPiecesAreTheReferences) {
  for (const test::Distribution& distribution : test::distributions()) {
    for (std::uint64_t seed = 200; seed < 200 + test::repetitions(3); ++seed) {
      test::Random random(seed);
      const test::Cloud cloud = distribution.make(random);
      const ConvexCutParameters parameters{.planes = seed == 200 ? 90U : 7U,
                                           .half_width_m = seed == 201 ? 0.25 : 0.05};
      SCOPED_TRACE(distribution.name);
      StreamingCut cut(parameters, cloud.size());
      expect_reference_labels_in_pieces(cut, parameters, cloud, random, 700);
    }
  }
}

TEST_P(StreamingOnEverySimdPath, LabelsOfATiltedRigsRevolutionAreTheReferences) {
  const ConvexCutParameters parameters{.planes = 180};
  StreamingCut cut(parameters, 40'000);
  for (const double tilt_deg : {0.0, 10.0, 30.0, 60.0, 90.0}) {
    test::Random random(5);
    const test::Cloud cloud = swept_room(tilt_deg, 600, random);
    for (const std::size_t largest : {400U, 3'000U}) {
      SCOPED_TRACE(tilt_deg);
      expect_reference_labels_in_pieces(cut, parameters, cloud, random, largest);
    }
  }
}

CONVEXCUT_ON_EVERY_SIMD_PATH(StreamingOnEverySimdPath);

TEST(StreamingCut, MostSlicesAreDoneBeforeTheLastFiring) {
  test::Random random(6);
  const test::Cloud cloud = swept_room(0.0, 2'170, random);
  StreamingCut cut({}, cloud.size());
  add_in_pieces(cut, cloud, random, 384);
  // The group at the cut azimuth is swept first and last.
  EXPECT_GT(cut.done().slices, 360U * 4 / 5);
  EXPECT_LE(cut.done().again, 15U);
  std::vector<Label> labels(cloud.size());
  ASSERT_EQ(cut.finish(cloud.view(), labels), CutStatus::ok);
  EXPECT_EQ(cut.done().slices - cut.done().again, 360U);
  EXPECT_LE(cut.done().again, 30U);
}

// A tilted rig sees the floor below itself at the end of a revolution as at its beginning: members
// of all slices that come late.
TEST(StreamingCut, PointsNearTheAxisThatComeLateLeaveMostSlicesDone) {
  test::Random random(8);
  const test::Cloud revolution = swept_room(60.0, 1'000, random);
  double lowest = 0.0;  // of those that are in every slice
  for (std::size_t i = 0; i < revolution.size(); ++i) {
    if (std::hypot(revolution.x[i], revolution.y[i]) > 0.05F) continue;
    lowest = std::min(lowest, static_cast<double>(revolution.z[i]));
  }
  ASSERT_LT(lowest, -1.0);
  StreamingCut cut({}, revolution.size() + 4);
  // Within the hull, a little outside, and so far that what the slices made structure is not.
  for (const double below_m : {-0.04, 0.005, 0.05}) {
    test::Cloud cloud = revolution;
    add_in_pieces(cut, cloud, random, 384);
    const std::uint32_t before = cut.done().slices;
    ASSERT_GT(before, 180U);
    for (const double x : {-0.01, 0.0, 0.01}) {
      cloud.add(x, 0.005, lowest - below_m);
    }
    std::vector<Label> expected(cloud.size());
    ASSERT_EQ(reference::label({}, cloud.view(), expected), CutStatus::ok);
    std::vector<Label> labels(cloud.size());
    ASSERT_EQ(cut.finish(cloud.view(), labels), CutStatus::ok);
    EXPECT_TRUE(labels == expected) << below_m;
    const std::uint32_t after = cut.done().slices - before;
    EXPECT_EQ(after < 180U, below_m < 0.02) << below_m << ": " << after << " of " << before;
  }
}

// The second point on top of a wall moves its hull up: what was structure by the first is not.
TEST(StreamingCut, APointThatComesIntoADoneSliceTakesLabelsBack) {
  test::Random random(7);
  test::Cloud cloud = swept_room(0.0, 1'000, random);
  StreamingCut cut({}, cloud.size() + 1);
  add_in_pieces(cut, cloud, random, 384);
  ASSERT_GT(cut.done().slices, 200U);
  std::vector<Label> before(cloud.size());
  ASSERT_EQ(reference::label({}, cloud.view(), before), CutStatus::ok);
  cloud.add(-20.0, -14.0, 6.0);  // in a few of the slices
  std::vector<Label> expected(cloud.size());
  ASSERT_EQ(reference::label({}, cloud.view(), expected), CutStatus::ok);
  std::vector<Label> labels(cloud.size());
  ASSERT_EQ(cut.finish(cloud.view(), labels), CutStatus::ok);
  EXPECT_TRUE(labels == expected);
  EXPECT_GT(cut.done().again, 0U);
  before.push_back(Label::structure);
  EXPECT_FALSE(before == expected);
}

// A round room whose floor is 2 cm higher towards 40° and 220°, and `count` points on the axis.
// They are 5 cm above the higher floor, structure for good by the slice of 40°, and 7 cm above the
// rest of it: the other slices leave them undecided, with e = 8 cm.
[[nodiscard]] test::Cloud room_with_steps(std::size_t count) {
  test::Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) cloud.add(0.0, 0.0, -0.93);
  for (int i = 0; i < 3'600; ++i) {
    const double azimuth_deg = 0.1 * i;
    const bool is_step = std::abs(std::fmod(azimuth_deg, 180.0) - 40.0) < 1.2;
    const double azimuth = azimuth_deg * std::numbers::pi / 180.0;
    for (const double z : {is_step ? -0.98 : -1.0, 1.0}) {
      cloud.add(3.0 * std::cos(azimuth), 3.0 * std::sin(azimuth), z);
    }
  }
  for (int i = 0; i < 400; ++i) cloud.add(0.0, 0.0, 0.0);
  return cloud;
}

// Towards 40°, 3 m away.
void add_hole(test::Cloud& cloud) {
  const double azimuth = 40.0 * std::numbers::pi / 180.0;
  cloud.add(3.0 * std::cos(azimuth), 3.0 * std::sin(azimuth), -1.5);
}

// A hole in the floor, seen at the end, takes away what that slice made structure. The
// other slices had left these points to it: a few, or more than they have room for.
TEST(StreamingCut, WhatASliceDoneAgainNoLongerMakesStructureOthersDecide) {
  const ConvexCutParameters parameters{.planes = 180};
  for (const std::size_t count : {100U, 9'000U}) {
    SCOPED_TRACE(count);
    test::Cloud cloud = room_with_steps(count);
    StreamingCut cut(parameters, cloud.size() + 1);
    test::Random random(9);
    add_in_pieces(cut, cloud, random, 384);
    ASSERT_GE(cut.done().slices, 180U);
    add_hole(cloud);
    std::vector<Label> expected(cloud.size());
    ASSERT_EQ(reference::label(parameters, cloud.view(), expected), CutStatus::ok);
    ASSERT_EQ(expected[0], Label::structure);
    std::vector<Label> labels(cloud.size());
    const std::uint32_t before = cut.done().slices;
    ASSERT_EQ(cut.finish(cloud.view(), labels), CutStatus::ok);
    EXPECT_TRUE(labels == expected);
    EXPECT_EQ(cut.done().slices - before < 20U, count == 100U);
  }
}

TEST(StreamingCut, SlicesThatLeaveMorePointsUndecidedThanThereIsRoomFor) {
  const test::Cloud room = room_with_steps(9'000);
  test::Cloud cloud;
  add_hole(cloud);
  for (std::size_t k = 0; k < room.size(); ++k) cloud.add_from(room, k);
  const ConvexCutParameters parameters{.planes = 60};
  StreamingCut cut(parameters, cloud.size());
  test::Random random(10);
  expect_reference_labels_in_pieces(cut, parameters, cloud, random, 384);
}

TEST(StreamingCut, OneAfterTheOther) {
  StreamingCut cut({.planes = 30}, 40'000);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    test::Random random(seed);
    const test::Cloud cloud = swept_room(5.0 * static_cast<double>(seed), 400, random);
    expect_reference_labels_in_pieces(cut, {.planes = 30}, cloud, random, 500);
  }
}

TEST(StreamingCut, RefusesWhatTheEngineRefusesUntilTheNextCloud) {
  StreamingCut cut({}, 3);
  test::Cloud cloud;
  std::vector<Label> labels(4);
  for (int i = 0; i < 4; ++i) cloud.add(1.0, i, 0.0);
  EXPECT_EQ(cut.finish(cloud.view(), std::span(labels).first(3)), CutStatus::size_mismatch);
  EXPECT_EQ(cut.add(cloud.view()), CutStatus::too_many_points);
  EXPECT_EQ(cut.add(first(cloud, 2)), CutStatus::too_many_points);
  cut.begin();
  EXPECT_EQ(cut.add(first(cloud, 2)), CutStatus::ok);
  cloud.z[2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(cut.add(first(cloud, 3)), CutStatus::coordinate_out_of_range);
  EXPECT_EQ(cut.finish(first(cloud, 2), std::span(labels).first(2)),
            CutStatus::coordinate_out_of_range);
  cut.begin();
  const CloudView all = cloud.view();
  EXPECT_EQ(cut.add({all.x.first(2), all.y.first(1), all.z.first(2)}), CutStatus::size_mismatch);
  EXPECT_THROW(StreamingCut({.planes = 0}, 10), std::invalid_argument);
}

TEST(StreamingCut, AnEmptyCloudHasNoLabels) {
  StreamingCut cut({}, 10);
  cut.begin();
  EXPECT_EQ(cut.finish({}, {}), CutStatus::ok);
}

}  // namespace
}  // namespace convexcut
