// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include <hwy/cache_control.h>

namespace convexcut {

// Returns when reached(value) is true, with acquire order: pairs with the release of the thread
// that changes the value and notifies. Spins for some 30 µs, for most waits are shorter than
// putting a thread to sleep and waking it; then sleeps, for it may be waiting for a thread that
// needs its processor.
template <class Reached>
std::uint32_t wait_until(const std::atomic<std::uint32_t>& value, Reached&& reached) noexcept {
  constexpr int kSpins = 1500;
  std::uint32_t seen = value.load(std::memory_order_acquire);
  for (int spin = 0; spin < kSpins && !reached(seen); ++spin) {
    hwy::Pause();
    seen = value.load(std::memory_order_acquire);
  }
  while (!reached(seen)) {
    value.wait(seen, std::memory_order_acquire);
    seen = value.load(std::memory_order_acquire);
  }
  return seen;
}

}  // namespace convexcut
