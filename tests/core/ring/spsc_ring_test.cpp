// SPDX-License-Identifier: Apache-2.0
//
// The ring from one thread: order, bounds, lifetimes and counts. Proves nothing about two threads:
// see ring_threads_test.cpp and index_protocol_test.cpp.
#include "core/ring/spsc_ring.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace convexcut {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

template <class T>
bool push(SpscRing<T>& ring, const T& value) {
  T* slot = ring.claim();
  if (slot == nullptr) return false;
  *slot = value;
  ring.commit();
  return true;
}

std::vector<int> drain(SpscRing<int>& ring,
                       std::size_t most = std::numeric_limits<std::size_t>::max()) {
  std::vector<int> values;
  ring.consume([&](const int& value) noexcept { values.push_back(value); }, most);
  return values;
}

TEST(SpscRing, CapacityIsRoundedUpToAPowerOfTwo) {
  EXPECT_EQ(SpscRing<int>(0).capacity(), 1U);
  EXPECT_EQ(SpscRing<int>(1).capacity(), 1U);
  EXPECT_EQ(SpscRing<int>(3).capacity(), 4U);
  EXPECT_EQ(SpscRing<int>(4).capacity(), 4U);
  EXPECT_EQ(SpscRing<int>(1000).capacity(), 1024U);
}

TEST(SpscRing, ACapacityBeyondMemoryIsRefused) {
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  EXPECT_THROW(SpscRing<std::uint64_t>{kMost}, std::length_error);
  EXPECT_THROW(SpscRing<std::uint64_t>{kMost / 8}, std::length_error);
}

TEST(SpscRing, IsEmptyWhenNew) {
  SpscRing<int> ring(4);
  EXPECT_EQ(ring.front(), nullptr);
  EXPECT_THAT(drain(ring), IsEmpty());
  EXPECT_EQ(ring.size_approx(), 0U);
  EXPECT_EQ(ring.overruns(), 0U);
}

TEST(SpscRing, GivesSamplesInOrder) {
  SpscRing<int> ring(4);
  for (const int value : {1, 2, 3}) ASSERT_TRUE(push(ring, value));
  for (const int value : {1, 2, 3}) {
    ASSERT_NE(ring.front(), nullptr);
    EXPECT_EQ(*ring.front(), value);
    ring.pop();
  }
  EXPECT_EQ(ring.front(), nullptr);
}

TEST(SpscRing, OrderSurvivesManyTurnsOfTheRing) {
  SpscRing<int> ring(4);
  int next_in = 0;
  int next_out = 0;
  // Batches of 3 into 4 slots: every slot is the first of a batch in turn.
  for (int round = 0; round < 1000; ++round) {
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(push(ring, next_in++));
    for (const int value : drain(ring)) ASSERT_EQ(value, next_out++);
  }
  EXPECT_EQ(next_out, 3000);
  EXPECT_EQ(ring.overruns(), 0U);
}

TEST(SpscRing, EverySlotIsUsableBeforeItIsFull) {
  SpscRing<int> ring(4);
  for (const int value : {1, 2, 3, 4}) EXPECT_TRUE(push(ring, value));
  EXPECT_EQ(ring.size_approx(), 4U);
  EXPECT_FALSE(push(ring, 5));
}

TEST(SpscRing, AFullRingDropsTheNewestAndKeepsTheRest) {
  SpscRing<int> ring(2);
  EXPECT_TRUE(push(ring, 1));
  EXPECT_TRUE(push(ring, 2));
  EXPECT_FALSE(push(ring, 3));
  EXPECT_THAT(drain(ring, 1), ElementsAre(1));
  EXPECT_TRUE(push(ring, 4));
  EXPECT_THAT(drain(ring), ElementsAre(2, 4));
}

TEST(SpscRing, EveryClaimOfAFullRingIsOneOverrun) {
  SpscRing<int> ring(1);
  ASSERT_TRUE(push(ring, 1));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(ring.claim(), nullptr);
  EXPECT_EQ(ring.overruns(), 5U);
}

TEST(SpscRing, SentEqualsPoppedPlusOverruns) {
  SpscRing<int> ring(8);
  constexpr std::uint64_t kSent = 1000;
  std::uint64_t popped = 0;
  for (std::uint64_t i = 0; i < kSent; ++i) {
    push(ring, static_cast<int>(i));
    if (i % 3 == 0) popped += drain(ring, 2).size();
  }
  popped += drain(ring).size();
  EXPECT_GT(ring.overruns(), 0U);
  EXPECT_EQ(popped + ring.overruns(), kSent);
}

TEST(SpscRing, AClaimWithoutCommitIsNotSeenAndIsClaimedAgain) {
  SpscRing<int> ring(2);
  int* abandoned = ring.claim();
  ASSERT_NE(abandoned, nullptr);
  *abandoned = 7;
  EXPECT_EQ(ring.front(), nullptr);
  EXPECT_EQ(ring.claim(), abandoned);
  EXPECT_EQ(ring.size_approx(), 0U);
  EXPECT_EQ(ring.overruns(), 0U);
}

TEST(SpscRing, ASlotStillHoldsItsEarlierSample) {
  SpscRing<std::vector<int>> ring(1);
  ring.claim()->assign(100, 1);
  ring.commit();
  ASSERT_NE(ring.front(), nullptr);
  ring.front()->clear();
  ring.pop();
  // What a slot owns is reused: filling it again allocates nothing.
  EXPECT_GE(ring.claim()->capacity(), 100U);
}

TEST(SpscRing, ABatchTakesNoMoreThanAskedFor) {
  SpscRing<int> ring(8);
  for (const int value : {1, 2, 3, 4, 5}) push(ring, value);
  EXPECT_THAT(drain(ring, 0), IsEmpty());
  EXPECT_THAT(drain(ring, 2), ElementsAre(1, 2));
  EXPECT_THAT(drain(ring, 100), ElementsAre(3, 4, 5));
}

TEST(SpscRing, ABatchSeesWhatWasCommittedSinceTheLastLook) {
  SpscRing<int> ring(8);
  push(ring, 1);
  ASSERT_NE(ring.front(), nullptr);  // the consumer has looked: one sample
  push(ring, 2);
  EXPECT_THAT(drain(ring), ElementsAre(1, 2));
}

TEST(SpscRing, ABatchGivesItsSlotsBackOnlyAtItsEnd) {
  SpscRing<int> ring(2);
  push(ring, 1);
  push(ring, 2);
  std::vector<bool> room;
  ring.consume([&](int&) noexcept { room.push_back(ring.claim() != nullptr); });
  EXPECT_THAT(room, ElementsAre(false, false));
  EXPECT_NE(ring.claim(), nullptr);
}

struct Tracked {
  Tracked() { alive().insert(this); }
  Tracked(const Tracked&) = delete;
  Tracked& operator=(const Tracked&) = delete;
  ~Tracked() { alive().erase(this); }

  static std::set<const Tracked*>& alive() {
    static std::set<const Tracked*> objects;
    return objects;
  }
};

TEST(SpscRing, SlotsLiveExactlyAsLongAsTheRing) {
  {
    SpscRing<Tracked> ring(4);
    EXPECT_EQ(Tracked::alive().size(), 4U);
    for (int i = 0; i < 10; ++i) {
      EXPECT_TRUE(Tracked::alive().contains(ring.claim()));
      ring.commit();
      ASSERT_NE(ring.front(), nullptr);
      ring.pop();
    }
    EXPECT_EQ(Tracked::alive().size(), 4U);
    ASSERT_NE(ring.claim(), nullptr);
    ring.commit();  // one sample is left queued
  }
  EXPECT_THAT(Tracked::alive(), IsEmpty());
}

struct ThrowsAtTheThird {
  ThrowsAtTheThird() {
    if (made + 1 == 3) throw std::runtime_error("third");
    ++made;
  }
  ~ThrowsAtTheThird() { --made; }
  static inline int made = 0;
};

TEST(SpscRing, AConstructorThatThrowsLeavesNothingBehind) {
  EXPECT_THROW(SpscRing<ThrowsAtTheThird>{4}, std::runtime_error);
  EXPECT_EQ(ThrowsAtTheThird::made, 0);
}

struct alignas(256) OverAligned {
  std::byte bytes[256];
};

TEST(SpscRing, SlotsAreAlignedToCacheLinesAndToTheirType) {
  SpscRing<char> chars(3);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(chars.claim()) % kCacheLine, 0U);
  SpscRing<OverAligned> wide(3);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(wide.claim()) % 256, 0U);
}

// What the receive threads rely on, checked by the compiler.
static_assert(noexcept(std::declval<SpscRing<int>&>().claim()));
static_assert(noexcept(std::declval<SpscRing<int>&>().commit()));
static_assert(noexcept(std::declval<SpscRing<int>&>().front()));
static_assert(noexcept(std::declval<SpscRing<int>&>().pop()));
static_assert(alignof(SpscRing<char>) == kCacheLine);

}  // namespace
}  // namespace convexcut
