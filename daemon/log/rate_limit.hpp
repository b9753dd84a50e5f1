// SPDX-License-Identifier: Apache-2.0
//
// Keeps a repeated event from flooding the log, without hiding how often it came.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "core/time.hpp"

namespace convexcut::daemon::log {

// Lets one event a period pass. One thread, one object an event:
//
//   if (const auto suppressed = limit.pass(now))
//     log::warning("publish_timeout", {{"suppressed", *suppressed}});
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;

  explicit RateLimit(Duration period) noexcept : period_(period) {}

  // When the event is to be logged: how many were not since the last that was. Else nothing.
  [[nodiscard]] std::optional<std::uint64_t> pass(Clock::time_point now) noexcept {
    if (now < next_) {
      ++suppressed_;
      return std::nullopt;
    }
    next_ = now + period_;
    const std::uint64_t suppressed = suppressed_;
    suppressed_ = 0;
    return suppressed;
  }

 private:
  Duration period_;
  Clock::time_point next_ = Clock::time_point::min();  // the first to pass
  std::uint64_t suppressed_ = 0;
};

}  // namespace convexcut::daemon::log
