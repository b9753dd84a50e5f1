// SPDX-License-Identifier: Apache-2.0
//
// Wake-ups between threads. Does not prove how soon a sleeper runs.
#include "daemon/wake_up.hpp"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "core/ring/spsc_ring.hpp"

namespace convexcut::daemon {
namespace {

constexpr Duration kLong = std::chrono::milliseconds{999};

TEST(WakeUp, OneThatCameBeforeTheWaitEndsIt) {
  WakeUp wake_up;
  const auto begin = std::chrono::steady_clock::now();
  wake_up.notify();
  wake_up.notify();
  wake_up.wait(kLong);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kLong);
}

TEST(WakeUp, EndsOneWaitOnly) {
  WakeUp wake_up;
  wake_up.notify();
  wake_up.wait(kLong);
  constexpr Duration kShort = std::chrono::milliseconds{5};
  const auto begin = std::chrono::steady_clock::now();
  wake_up.wait(kShort);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, kShort);
}

// The way the publishers use it. A missed wake-up would cost a whole wait each.
TEST(WakeUp, NoSampleOfARingIsSleptOver) {
  constexpr int kSamples = 20'000;
  SpscRing<int> ring(8);
  WakeUp filled;
  std::thread producer([&] {
    for (int i = 0; i < kSamples;) {
      int* slot = ring.claim();
      if (slot == nullptr) {
        std::this_thread::yield();
        continue;
      }
      *slot = i++;
      ring.commit();
      filled.notify();
    }
  });
  int expected = 0;
  int slept_over = 0;
  while (expected < kSamples) {
    const bool came =
        ring.consume([&](int& sample) noexcept { EXPECT_EQ(sample, expected++); }) > 0;
    if (came) continue;
    const auto begin = std::chrono::steady_clock::now();
    filled.wait(kLong);
    slept_over += std::chrono::steady_clock::now() - begin >= kLong ? 1 : 0;
  }
  producer.join();
  EXPECT_EQ(slept_over, 0);
}

}  // namespace
}  // namespace convexcut::daemon
