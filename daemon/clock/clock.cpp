// SPDX-License-Identifier: Apache-2.0
#include "daemon/clock/clock.hpp"

#include <algorithm>
#include <ctime>

namespace convexcut::daemon {
namespace {

// A long wait looks at the stop flag this often.
constexpr auto kLongestNap = std::chrono::milliseconds{50};

}  // namespace

void Clock::wait_until(HostTime time) const noexcept {
  if (paced()) sleep_until(steady_at(time));
}

void Clock::wait_until(Steady::time_point time) const noexcept {
  if (paced()) sleep_until(time);
}

void Clock::pause(Duration span) const noexcept {
  sleep_until(paced() ? steady_at(now() + span) : Steady::now() + span);
}

// Not std::this_thread::sleep_until: that of libstdc++ 12 sleeps for the difference, and what
// preempts it between looking at the clock and sleeping makes it late.
void Clock::sleep_until(Steady::time_point time) const noexcept {
  // Relaxed: the flag only ends waiting, it publishes nothing.
  while (!stop_.load(std::memory_order_relaxed)) {
    const auto now = Steady::now();
    if (now >= time) return;
    const Duration until = std::min(time, now + kLongestNap).time_since_epoch();
    const auto whole = std::chrono::floor<std::chrono::seconds>(until);
    const std::timespec at{whole.count(), (until - whole).count()};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
  }
}

}  // namespace convexcut::daemon
