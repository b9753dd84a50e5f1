// SPDX-License-Identifier: Apache-2.0
#include "daemon/clock/playback_clock.hpp"

namespace convexcut::daemon {
namespace {

[[nodiscard]] Duration scaled(Duration span, double factor) noexcept {
  return Duration{static_cast<Duration::rep>(static_cast<double>(span.count()) * factor)};
}

}  // namespace

void PlaybackClock::start(HostTime first) noexcept {
  origin_ = first;
  origin_steady_ = Steady::now();
  newest_ns_.store(to_ns(first), std::memory_order_release);  // pairs with now()
}

HostTime PlaybackClock::now() const noexcept {
  if (!paced()) return from_ns<HostTime>(newest_ns_.load(std::memory_order_acquire));
  return host_at(Steady::now());
}

Clock::Steady::time_point PlaybackClock::steady_at(HostTime time) const noexcept {
  return origin_steady_ + scaled(time - origin_, 1.0 / rate_);
}

HostTime PlaybackClock::host_at(Steady::time_point time) const noexcept {
  return origin_ + scaled(time - origin_steady_, rate_);
}

void PlaybackClock::delivered(HostTime stamp) noexcept {
  // Relaxed: this thread's own last store. The store pairs with the acquire in now().
  if (to_ns(stamp) > newest_ns_.load(std::memory_order_relaxed)) {
    newest_ns_.store(to_ns(stamp), std::memory_order_release);
  }
}

}  // namespace convexcut::daemon
