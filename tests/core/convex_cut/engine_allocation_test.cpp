// SPDX-License-Identifier: Apache-2.0
//
// The engine allocates nothing once it is made. Does not see allocations that go to malloc
// directly; the engine's sources have none.
#include <cstdint>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/engine.hpp"
#include "tests/core/convex_cut/clouds.hpp"
#include "tests/support/allocations.hpp"

namespace convexcut {
namespace {

TEST(CountingAllocator, Counts) {
  const std::uint64_t before = test::allocations();
  ::operator delete(::operator new(100));
  EXPECT_EQ(test::allocations(), before + 1);
}

class EngineAllocation : public testing::TestWithParam<unsigned> {};

TEST_P(EngineAllocation, LabelAllocatesNothing) {
  ConvexCutEngine engine({}, 40'000, GetParam());
  for (const std::size_t points : {0U, 1U, 100U, 40'000U, 5'000U}) {
    test::Random random(points);
    const test::Cloud cloud = test::furnished_room(random, points);
    std::vector<Label> labels(points);
    const std::uint64_t before = test::allocations();
    const CutStatus status = engine.label(cloud.view(), labels);
    EXPECT_EQ(test::allocations() - before, 0U) << points;
    EXPECT_EQ(status, CutStatus::ok);
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, EngineAllocation, testing::Values(1U, 2U, 4U));

}  // namespace
}  // namespace convexcut
