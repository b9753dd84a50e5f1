// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "drivers/live/live_source.hpp"

namespace convexcut::live {

// The state of a link and its newest error as other threads may read them.
//
// Written by the source's thread alone. Relaxed throughout: each is a value on its own that orders
// nothing, and pairs with the relaxed loads below.
class LinkStatus {
 public:
  void set_open() noexcept {
    error_.store(0, std::memory_order_relaxed);
    state_.store(LinkState::open, std::memory_order_relaxed);
  }
  void set(LinkState state, int error_number) noexcept {
    error_.store(error_number, std::memory_order_relaxed);
    state_.store(state, std::memory_order_relaxed);
  }

  [[nodiscard]] LinkState state() const noexcept { return state_.load(std::memory_order_relaxed); }
  [[nodiscard]] int last_error() const noexcept { return error_.load(std::memory_order_relaxed); }

 private:
  std::atomic<LinkState> state_{LinkState::closed};
  std::atomic<int> error_{0};
};

}  // namespace convexcut::live
