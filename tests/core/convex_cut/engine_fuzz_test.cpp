// SPDX-License-Identifier: Apache-2.0
//
// Clouds of random bytes, as the fuzzer makes them of its own: the labels are the reference's on
// every instruction set of this processor. Does not look for new kinds of clouds, as the fuzzer
// does.
#include <array>
#include <random>

#include <gtest/gtest.h>

#include "tests/fuzz/convex_cut/fuzzed_cloud.hpp"
#include "tests/support/effort.hpp"

namespace convexcut {
namespace {

TEST(EngineOnFuzzedClouds, LabelsAreTheReferences) {
  // NOLINTNEXTLINE(cert-msc32-c,cert-msc51-cpp)
  std::mt19937 random(2026);
  std::size_t points = 0;
  for (std::uint64_t round = 0; round < test::repetitions(150); ++round) {
    std::array<std::uint8_t, 160> bytes{};
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const test::FuzzedCloud input = test::fuzzed_cloud(bytes);
    points += input.cloud.size();
    ASSERT_EQ(test::differing_path(input), "") << "round " << round;
  }
  EXPECT_GT(points, 50 * test::repetitions(150));
}

}  // namespace
}  // namespace convexcut
