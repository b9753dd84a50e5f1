// SPDX-License-Identifier: Apache-2.0
//
// A program of its own: it replaces the global operator new to count. Does not see allocations that
// go to malloc directly; the engine's sources have none.
#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/engine.hpp"
#include "tests/core/convex_cut/clouds.hpp"

// NOLINTBEGIN(cppcoreguidelines-no-malloc): operator new is what it is replaced by here

namespace {

std::atomic<std::size_t> allocations{0};

[[nodiscard]] void* counted(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  void* const memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

// NOLINTEND(cppcoreguidelines-no-malloc)

namespace convexcut {
namespace {

TEST(CountingAllocator, Counts) {
  const std::size_t before = allocations.load();
  ::operator delete(::operator new(100));
  EXPECT_EQ(allocations.load(), before + 1);
}

class EngineAllocation : public testing::TestWithParam<unsigned> {};

TEST_P(EngineAllocation, LabelAllocatesNothing) {
  ConvexCutEngine engine({}, 40'000, GetParam());
  for (const std::size_t points : {0U, 1U, 100U, 40'000U, 5'000U}) {
    test::Random random(points);
    const test::Cloud cloud = test::furnished_room(random, points);
    std::vector<Label> labels(points);
    const std::size_t before = allocations.load();
    const CutStatus status = engine.label(cloud.view(), labels);
    EXPECT_EQ(allocations.load() - before, 0U) << points;
    EXPECT_EQ(status, CutStatus::ok);
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, EngineAllocation, testing::Values(1U, 2U, 4U));

}  // namespace
}  // namespace convexcut
