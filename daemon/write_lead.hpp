// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

#include "core/time.hpp"

namespace convexcut::daemon {

// How much earlier than due a write begins, so that it returns when it is due: what writes usually
// take. One that took much longer moves it little, or it would draw the next ones forward.
class WriteLead {
 public:
  static constexpr Duration kLongest = std::chrono::milliseconds{2};
  static constexpr Duration kLargestStep = std::chrono::microseconds{20};

  [[nodiscard]] Duration value() const noexcept { return lead_; }

  void observe(Duration write) noexcept {
    const Duration taken = std::clamp(write, Duration::zero(), kLongest);
    if (!started_) {
      started_ = true;
      lead_ = taken;
      return;
    }
    lead_ += std::clamp((taken - lead_) / kMemory, -kLargestStep, kLargestStep);
  }

 private:
  static constexpr int kMemory = 8;  // writes

  Duration lead_{0};
  bool started_ = false;
};

}  // namespace convexcut::daemon
