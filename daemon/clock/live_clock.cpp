// SPDX-License-Identifier: Apache-2.0
#include "daemon/clock/live_clock.hpp"

#include <ctime>

namespace convexcut::daemon {
namespace {

// A reading between two of the other clock that are this near cannot be far off; more often than
// this it is not tried, a preempted reading is only less exact.
constexpr Duration kNear = std::chrono::microseconds{20};
constexpr int kTries = 4;

}  // namespace

LiveClock::LiveClock(const std::atomic<bool>& stop, ReadOffset read) noexcept
    : Clock(stop), read_(read), offset_ns_(read().count()) {}

Clock::Steady::time_point LiveClock::steady_at(HostTime time) const noexcept {
  return Steady::time_point{time.time_since_epoch() - offset()};
}

HostTime LiveClock::host_at(Steady::time_point time) const noexcept {
  return HostTime{time.time_since_epoch() + offset()};
}

Duration LiveClock::take_step() noexcept {
  const Duration read = read_();
  const Duration change = read - offset();
  if (change == Duration::zero()) return change;
  if (change > -kSmallestStep && change < kSmallestStep) {
    // What is within a reading's own error is not followed: now() would tremble.
    if (change > kNear || change < -kNear) {
      offset_ns_.store(read.count(), std::memory_order_relaxed);
    }
    return Duration::zero();
  }
  offset_ns_.store(read.count(), std::memory_order_relaxed);
  steps_.add();
  return change;
}

Duration LiveClock::read_offset() noexcept {
  Duration best{};
  Duration best_width = Duration::max();
  for (int i = 0; i < kTries && best_width > kNear; ++i) {
    const auto before = Steady::now();
    std::timespec real{};
    ::clock_gettime(CLOCK_REALTIME, &real);
    const auto after = Steady::now();
    if (after - before >= best_width) continue;
    best_width = after - before;
    best = std::chrono::seconds{real.tv_sec} + std::chrono::nanoseconds{real.tv_nsec} -
           (before + best_width / 2).time_since_epoch();
  }
  return best;
}

Duration LiveClock::offset() const noexcept {
  return Duration{offset_ns_.load(std::memory_order_relaxed)};
}

}  // namespace convexcut::daemon
