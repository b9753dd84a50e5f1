// SPDX-License-Identifier: Apache-2.0
//
// The engine gives exactly the reference's labels: every point, every thread count, no tolerance.
// Does not prove the reference right (reference_test, hull_test), nor the engine fast (bench).
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/engine.hpp"
#include "core/convex_cut/reference.hpp"
#include "tests/core/convex_cut/clouds.hpp"
#include "tests/core/convex_cut/every_simd_path.hpp"
#include "tests/support/effort.hpp"

namespace convexcut {
namespace {

constexpr std::array<std::uint32_t, 6> kPlanes{1, 2, 3, 7, 360, 720};
constexpr std::array<double, 5> kHalfWidths{0.05, 0.25, 1e-4, 2.0, 1e-6};
constexpr std::array<double, 5> kHullDistances{0.08, 0.25, 0.0, 1.0, 50.0};

[[nodiscard]] ConvexCutParameters any_parameters(test::Random& random) {
  return {kPlanes.at(random.index(kPlanes.size())),
          kHalfWidths.at(random.index(kHalfWidths.size())),
          kHullDistances.at(random.index(kHullDistances.size()))};
}

// The index of the first label that differs, or the number of labels.
[[nodiscard]] std::size_t first_difference(const std::vector<Label>& a,
                                           const std::vector<Label>& b) {
  return static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
}

class EngineOracle : public testing::TestWithParam<test::Distribution> {};

TEST_P(EngineOracle, LabelsAreTheReferencesForEveryThreadCount) {
  for (std::uint64_t seed = 0; seed < test::repetitions(20); ++seed) {
    test::Random random(seed);
    const test::Cloud cloud = GetParam().make(random);
    // The default first; the dense cloud would take the reference minutes with many wide slices.
    const ConvexCutParameters parameters =
        seed == 0 ? ConvexCutParameters{} : any_parameters(random);
    std::vector<Label> expected(cloud.size());
    ASSERT_EQ(reference::label(parameters, cloud.view(), expected), CutStatus::ok);
    for (const unsigned threads : {1U, 2U, 3U, 4U}) {
      ConvexCutEngine engine(parameters, cloud.size(), threads);
      std::vector<Label> labels(cloud.size());
      ASSERT_EQ(engine.label(cloud.view(), labels), CutStatus::ok);
      ASSERT_EQ(first_difference(labels, expected), cloud.size())
          << "seed " << seed << ", " << threads << " threads, n = " << parameters.planes
          << ", d = " << parameters.half_width_m << ", e = " << parameters.hull_distance_m;
    }
  }
}

// Of one thread, with the instruction set at hand.
void expect_labels_of_reference(const ConvexCutParameters& parameters, const test::Cloud& cloud) {
  std::vector<Label> expected(cloud.size());
  std::vector<Label> labels(cloud.size());
  ASSERT_EQ(reference::label(parameters, cloud.view(), expected), CutStatus::ok);
  ConvexCutEngine engine(parameters, cloud.size(), 1);
  ASSERT_EQ(engine.label(cloud.view(), labels), CutStatus::ok);
  ASSERT_EQ(first_difference(labels, expected), cloud.size());
}

class EngineOnEverySimdPath : public test::EverySimdPath {};

TEST_P(EngineOnEverySimdPath, LabelsAreTheReferences) {
  for (const test::Distribution& distribution : test::distributions()) {
    for (std::uint64_t seed = 100; seed < 100 + test::repetitions(3); ++seed) {
      test::Random random(seed);
      const test::Cloud cloud = distribution.make(random);
      const ConvexCutParameters parameters =
          seed == 100 ? ConvexCutParameters{} : any_parameters(random);
      SCOPED_TRACE(std::string(distribution.name) + ", seed " + std::to_string(seed));
      ASSERT_NO_FATAL_FAILURE(expect_labels_of_reference(parameters, cloud));
    }
  }
}

TEST_P(EngineOnEverySimdPath, LabelsAreTheReferencesInSlicesOfManyMembers) {
  test::Random random(9);
  test::Cloud cloud = test::furnished_room(random, 25'000);
  for (int i = 0; i < 5'000; ++i) {  // all of them candidates for the hull of a slice
    const double angle = random.uniform(0.0, 6.28);
    cloud.add(6.0 * std::cos(angle), random.uniform(-1.0, 1.0), 6.0 * std::sin(angle));
  }
  const ConvexCutParameters parameters{.planes = 3, .half_width_m = 1.0};
  expect_labels_of_reference(parameters, cloud);
}

TEST_P(EngineOnEverySimdPath, LabelsAreTheReferencesWhereOnlyRoundingToFloatBendsALine) {
  test::Cloud cloud;
  for (int k = 1; k <= 42; ++k) cloud.add(k * 3.12e-7, k * 1.3569e-5, k * 1.5102e-5);
  cloud.add(2.54e-7, 0, 0);
  const ConvexCutParameters parameters{.planes = 16, .half_width_m = 1e-4, .hull_distance_m = 0.0};
  expect_labels_of_reference(parameters, cloud);
}

CONVEXCUT_ON_EVERY_SIMD_PATH(EngineOnEverySimdPath);

INSTANTIATE_TEST_SUITE_P(AllDistributions, EngineOracle, testing::ValuesIn(test::distributions()),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(EngineReuse, OneEngineLabelsAnyCloudsOneAfterTheOther) {
  ConvexCutEngine engine({.planes = 60}, 10'000, 2);
  test::Random random(7);
  for (int round = 0; round < 3; ++round) {
    for (const test::Distribution& distribution : test::distributions()) {
      const test::Cloud cloud = distribution.make(random);
      std::vector<Label> expected(cloud.size());
      std::vector<Label> labels(cloud.size());
      ASSERT_EQ(reference::label(engine.parameters(), cloud.view(), expected), CutStatus::ok);
      ASSERT_EQ(engine.label(cloud.view(), labels), CutStatus::ok);
      ASSERT_EQ(first_difference(labels, expected), cloud.size()) << distribution.name;
    }
  }
}

TEST(EngineReuse, AMillionPointsFit) {
  CONVEXCUT_LONG_TEST();
  test::Random random(8);
  const test::Cloud cloud = test::furnished_room(random, 1'000'000);
  const ConvexCutParameters parameters{.planes = 6};
  ConvexCutEngine engine(parameters, cloud.size(), 2);
  std::vector<Label> expected(cloud.size());
  std::vector<Label> labels(cloud.size());
  ASSERT_EQ(reference::label(parameters, cloud.view(), expected), CutStatus::ok);
  ASSERT_EQ(engine.label(cloud.view(), labels), CutStatus::ok);
  EXPECT_EQ(first_difference(labels, expected), cloud.size());
}

}  // namespace
}  // namespace convexcut
