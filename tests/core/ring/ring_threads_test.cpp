// SPDX-License-Identifier: Apache-2.0
//
// Two threads at once, with every sample checked for wholeness and order. Under ThreadSanitizer
// this also proves that slots and indices are ordered by the atomics alone. It does not prove all
// interleavings (index_protocol_test.cpp does, for a model) nor anything of weakly ordered
// processors beyond what the sanitizer's happens-before rules say.
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "core/ring/spsc_ring.hpp"
#include "tests/support/effort.hpp"

namespace convexcut {
namespace {

// Big enough that a torn read would show: every word follows from the number.
struct Block {
  std::uint64_t number = 0;
  std::array<std::uint64_t, 15> words{};

  static std::uint64_t word(std::uint64_t number, std::size_t i) noexcept {
    return (number + 1) * 0x9E37'79B9'7F4A'7C15U + i;
  }
  void fill(std::uint64_t n) noexcept {
    number = n;
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = word(n, i);
  }
  [[nodiscard]] bool whole() const noexcept {
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] != word(number, i)) return false;
    }
    return true;
  }
};

struct Tally {
  std::uint64_t popped = 0;
  std::uint64_t torn = 0;
  std::uint64_t out_of_order = 0;
  std::uint64_t next_allowed = 0;

  void take(const Block& block) noexcept {
    ++popped;
    if (!block.whole()) ++torn;
    if (block.number < next_allowed) ++out_of_order;
    next_allowed = block.number + 1;
  }
};

enum class Policy { lossless, drop };

// The producer sends `sent` blocks; on a full ring it either tries again or drops the block.
void produce(SpscRing<Block>& ring, std::uint64_t sent, Policy policy) {
  for (std::uint64_t n = 0; n < sent; ++n) {
    Block* slot = ring.claim();
    while (slot == nullptr && policy == Policy::lossless) {
      std::this_thread::yield();
      slot = ring.claim();
    }
    if (slot == nullptr) {
      // Lets the consumer make room now and then, so that both outcomes occur often.
      if (n % 5 == 0) std::this_thread::yield();
      continue;
    }
    slot->fill(n);
    ring.commit();
  }
}

Tally run(SpscRing<Block>& ring, std::uint64_t sent, Policy policy, std::size_t batch) {
  std::atomic<bool> done{false};
  std::thread producer([&] {
    produce(ring, sent, policy);
    done.store(true, std::memory_order_release);  // pairs with the load below
  });
  Tally tally;
  while (true) {
    // Asked before the last look: what was committed before `done` is then seen.
    const bool last_look = done.load(std::memory_order_acquire);  // pairs with the store above
    const std::size_t count =
        ring.consume([&](const Block& block) noexcept { tally.take(block); }, batch);
    EXPECT_LE(ring.size_approx(), ring.capacity());
    if (count == 0 && last_look) break;
    if (count == 0) std::this_thread::yield();
  }
  producer.join();
  return tally;
}

class RingThreads : public testing::TestWithParam<std::size_t> {};

TEST_P(RingThreads, EveryBlockArrivesWholeAndInOrder) {
  SpscRing<Block> ring(GetParam());
  const std::uint64_t sent = test::repetitions(100'000);
  const Tally tally = run(ring, sent, Policy::lossless, 64);
  EXPECT_EQ(tally.popped, sent);
  EXPECT_EQ(tally.torn, 0U);
  EXPECT_EQ(tally.out_of_order, 0U);
}

TEST_P(RingThreads, WhatIsDroppedIsCountedExactly) {
  SpscRing<Block> ring(GetParam());
  constexpr std::uint64_t kSent = 300'000;  // enough for the consumer to get a turn
  const Tally tally = run(ring, kSent, Policy::drop, 3);
  EXPECT_EQ(tally.popped + ring.overruns(), kSent);
  EXPECT_GT(tally.popped, ring.capacity());
  EXPECT_EQ(tally.torn, 0U);
  EXPECT_EQ(tally.out_of_order, 0U);
}

INSTANTIATE_TEST_SUITE_P(Capacity, RingThreads, testing::Values(1, 2, 4, 1024),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace convexcut
