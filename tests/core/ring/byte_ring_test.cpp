// SPDX-License-Identifier: Apache-2.0
//
// One thread against a queue of the standard library, then two threads with every byte checked.
// The protocol of the indices is that of SpscRing, whose interleavings index_protocol_test.cpp
// visits; they are not visited again for this one.
#include "core/ring/byte_ring.hpp"

#include <cstdint>
#include <deque>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/effort.hpp"

namespace convexcut {
namespace {

// A record whose bytes all follow from its number.
std::byte byte_of(std::uint64_t number, std::size_t i) {
  return static_cast<std::byte>(number * 131 + i * 7);
}
bool push(ByteRing& ring, std::uint64_t number, std::size_t size) {
  const std::span<std::byte> room = ring.claim(size);
  if (room.empty()) return false;
  for (std::size_t i = 0; i < size; ++i) room[i] = byte_of(number, i);
  ring.commit();
  return true;
}
bool is_record(std::span<const std::byte> record, std::uint64_t number, std::size_t size) {
  if (record.size() != size) return false;
  for (std::size_t i = 0; i < size; ++i) {
    if (record[i] != byte_of(number, i)) return false;
  }
  return true;
}

TEST(ByteRing, IsEmptyAtFirstAndAfterEverythingWasTaken) {
  ByteRing ring(1024);
  EXPECT_TRUE(ring.front().empty());
  ASSERT_TRUE(push(ring, 1, 5));
  EXPECT_TRUE(is_record(ring.front(), 1, 5));
  EXPECT_TRUE(is_record(ring.front(), 1, 5)) << "looking takes nothing";
  ring.pop();
  EXPECT_TRUE(ring.front().empty());
  EXPECT_EQ(ring.overruns(), 0U);
}

TEST(ByteRing, CapacityIsAPowerOfTwoOfAtLeastAKilobyte) {
  EXPECT_EQ(ByteRing(0).capacity(), 1024U);
  EXPECT_EQ(ByteRing(1025).capacity(), 2048U);
}

TEST(ByteRing, WhatDoesNotFitIsDroppedAndCountedAndTheRestStaysInOrder) {
  ByteRing ring(1024);
  std::uint64_t pushed = 0;
  while (push(ring, pushed, 100)) ++pushed;
  EXPECT_EQ(pushed, 9U);  // of 104 + 8 bytes
  EXPECT_FALSE(push(ring, 99, 100));
  EXPECT_EQ(ring.overruns(), 2U);
  for (std::uint64_t number = 0; number < pushed; ++number) {
    EXPECT_TRUE(is_record(ring.front(), number, 100)) << number;
    ring.pop();
  }
  EXPECT_TRUE(ring.front().empty());
}

TEST(ByteRing, LargestRecordFitsWhereverTheRingStands) {
  for (std::size_t offset = 0; offset < 1024; offset += 16) {
    ByteRing ring(1024);
    for (std::size_t moved = 0; moved < offset; moved += 16) {
      ASSERT_TRUE(push(ring, 7, 1));  // 16 bytes with header and padding
      ASSERT_TRUE(is_record(ring.front(), 7, 1));
      ring.pop();
    }
    ASSERT_TRUE(push(ring, 3, ring.largest_record())) << offset;
    EXPECT_TRUE(is_record(ring.front(), 3, ring.largest_record())) << offset;
    EXPECT_TRUE(ring.claim(ring.largest_record() + 1).empty());
    EXPECT_EQ(ring.overruns(), 1U);
  }
}

TEST(ByteRing, AnAbandonedClaimLeavesNothing) {
  ByteRing ring(1024);
  ASSERT_FALSE(ring.claim(300).empty());
  EXPECT_TRUE(ring.front().empty());
  ASSERT_TRUE(push(ring, 5, 20));
  EXPECT_TRUE(is_record(ring.front(), 5, 20));
}

TEST(ByteRing, BehavesAsAQueueWithRoomForSoManyBytes) {
  std::mt19937 random(42);
  for (int round = 0; round < 50; ++round) {
    ByteRing ring(4096);
    std::deque<std::pair<std::uint64_t, std::size_t>> queue;
    std::uint64_t number = 0;
    std::uint64_t refused = 0;
    for (int step = 0; step < 2000; ++step) {
      if (random() % 2 == 0) {
        const std::size_t size = 1 + random() % (random() % 8 == 0 ? 2040 : 200);
        if (push(ring, number, size)) {
          queue.emplace_back(number, size);
        } else {
          ++refused;
          std::size_t used = size + 8;
          for (const auto& [n, s] : queue) used += s + 16;
          EXPECT_GT(used + 2048, ring.capacity()) << "refused with much room left";
        }
        ++number;
      } else if (!queue.empty()) {
        ASSERT_TRUE(is_record(ring.front(), queue.front().first, queue.front().second));
        ring.pop();
        queue.pop_front();
      } else {
        ASSERT_TRUE(ring.front().empty());
      }
    }
    EXPECT_EQ(ring.overruns(), refused);
  }
}

TEST(ByteRing, TwoThreadsLoseNothingButWhatIsCounted) {
  ByteRing ring(16 * 1024);
  const std::uint64_t records = test::repetitions(100'000);
  const auto size_of = [](std::uint64_t number) -> std::size_t { return 8 + number * 37 % 1500; };
  std::atomic<bool> done{false};
  std::thread producer([&] {
    for (std::uint64_t number = 0; number < records; ++number) {
      const std::size_t size = size_of(number);
      std::span<std::byte> room = ring.claim(size);
      // Every other record is insisted on, so that the ring is full most of the time.
      while (room.empty() && number % 2 == 0) {
        std::this_thread::yield();
        room = ring.claim(size);
      }
      if (room.empty()) continue;
      std::memcpy(room.data(), &number, sizeof number);
      for (std::size_t i = sizeof number; i < size; ++i) room[i] = byte_of(number, i);
      ring.commit();
    }
    done.store(true, std::memory_order_release);  // pairs with the load below
  });
  std::uint64_t taken = 0;
  std::uint64_t next = 0;
  for (;;) {
    const bool last_look = done.load(std::memory_order_acquire);
    for (auto record = ring.front(); !record.empty(); record = ring.front()) {
      std::uint64_t number = 0;
      ASSERT_GE(record.size(), sizeof number);
      std::memcpy(&number, record.data(), sizeof number);
      ASSERT_GE(number, next);
      ASSERT_EQ(record.size(), size_of(number));
      for (std::size_t i = sizeof number; i < record.size(); ++i) {
        ASSERT_EQ(record[i], byte_of(number, i));
      }
      next = number + 1;
      ++taken;
      ring.pop();
    }
    if (last_look) break;
  }
  producer.join();
  EXPECT_GE(taken, records / 2);
  EXPECT_GE(taken + ring.overruns(), records);
}

}  // namespace
}  // namespace convexcut
