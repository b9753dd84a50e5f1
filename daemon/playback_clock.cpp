// SPDX-License-Identifier: Apache-2.0
#include "daemon/playback_clock.hpp"

#include <algorithm>
#include <thread>

namespace convexcut::daemon {
namespace {

// A long wait looks at the stop flag this often.
constexpr auto kLongestNap = std::chrono::milliseconds{50};

}  // namespace

void PlaybackClock::start(HostTime first) noexcept {
  origin_ = first;
  origin_steady_ = Steady::now();
  newest_ns_.store(to_ns(first), std::memory_order_release);  // pairs with now()
}

HostTime PlaybackClock::now() const noexcept {
  if (!paced()) return from_ns<HostTime>(newest_ns_.load(std::memory_order_acquire));
  const auto elapsed = std::chrono::duration<double, std::nano>(Steady::now() - origin_steady_);
  return origin_ + Duration{static_cast<Duration::rep>(elapsed.count() * rate_)};
}

void PlaybackClock::wait_until(HostTime time) const noexcept {
  if (!paced()) return;
  const auto real = std::chrono::duration<double, std::nano>(time - origin_) / rate_;
  const Steady::time_point due =
      origin_steady_ + Duration{static_cast<Duration::rep>(real.count())};
  // Relaxed: the flag only ends waiting, it publishes nothing.
  while (!stop_.load(std::memory_order_relaxed)) {
    const auto now = Steady::now();
    if (now >= due) return;
    std::this_thread::sleep_until(std::min(due, now + kLongestNap));
  }
}

void PlaybackClock::pause(Duration span) const noexcept {
  const double scale = paced() ? 1.0 / rate_ : 1.0;
  std::this_thread::sleep_for(std::chrono::duration<double, std::nano>(span) * scale);
}

void PlaybackClock::delivered(HostTime stamp) noexcept {
  // Relaxed: this thread's own last store. The store pairs with the acquire in now().
  if (to_ns(stamp) > newest_ns_.load(std::memory_order_relaxed)) {
    newest_ns_.store(to_ns(stamp), std::memory_order_release);
  }
}

}  // namespace convexcut::daemon
