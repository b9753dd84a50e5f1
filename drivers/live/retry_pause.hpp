// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/time.hpp"
#include "drivers/live/host_clock.hpp"

namespace convexcut::live {

// Keeps what is tried again and again (opening a device, joining a group) to a few times a second.
// One thread.
class RetryPause {
 public:
  static constexpr Duration kPause = std::chrono::milliseconds{250};

  // True when a try is due; the next is then due a pause later.
  [[nodiscard]] bool take(Steady::time_point now) noexcept {
    if (now < next_) return false;
    next_ = now + kPause;
    return true;
  }
  // The next try is a pause away, whenever the last one was.
  void restart(Steady::time_point now) noexcept { next_ = now + kPause; }
  // How long to wait for it, at most `longest`.
  [[nodiscard]] Duration left(Steady::time_point now, Duration longest) const noexcept {
    return std::clamp(Duration{next_ - now}, Duration{0}, std::max(longest, Duration{0}));
  }

 private:
  Steady::time_point next_{};
};

}  // namespace convexcut::live
