// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace convexcut {

// An event count with one writing thread and any number of reading ones.
class Counter {
 public:
  Counter() = default;

  void add(std::uint64_t n = 1) noexcept {
    // One writer: a plain load and store, no locked instruction. Relaxed: a count orders nothing,
    // it pairs with the relaxed load in value().
    count_.store(count_.load(std::memory_order_relaxed) + n, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t value() const noexcept {
    return count_.load(std::memory_order_relaxed);  // pairs with add()
  }

 private:
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace convexcut
