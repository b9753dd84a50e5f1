// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

#include "core/clock/lower_envelope.hpp"
#include "core/time.hpp"

namespace convexcut::daemon {

// Where the host time of a sensor's samples comes from.
enum class TimeSource : std::uint8_t {
  none,      // no sample yet
  arrival,   // the samples have no time of their own
  envelope,  // estimated from when they arrive
  pps,       // the sensor's own UTC
};

[[nodiscard]] constexpr std::string_view name_of(TimeSource source) noexcept {
  switch (source) {
    case TimeSource::none:
      return "none";
    case TimeSource::arrival:
      return "arrival";
    case TimeSource::envelope:
      return "envelope";
    case TimeSource::pps:
      return "pps";
  }
  return "none";
}

// One sensor's clock, as it is shown.
struct ClockHealth {
  TimeSource source = TimeSource::none;
  bool locked = false;  // the skew is known
  Duration offset{};    // host − sensor
  Duration jitter{};
  double skew_ppm = 0.0;
  std::uint32_t steps = 0;
};

// Carries a ClockHealth from the thread that has the clock (the worker) to those that show it.
// Relaxed throughout: each number stands for itself, store() pairs with load().
class ClockGauge {
 public:
  // The writing thread. RT.
  void store(TimeSource source, const ClockState& state) noexcept {
    source_.store(source, std::memory_order_relaxed);
    locked_.store(state.locked, std::memory_order_relaxed);
    offset_ns_.store(state.offset.count(), std::memory_order_relaxed);
    jitter_ns_.store(state.jitter.count(), std::memory_order_relaxed);
    skew_ppm_.store(state.skew_ppm, std::memory_order_relaxed);
    steps_.store(state.steps, std::memory_order_relaxed);
  }

  [[nodiscard]] ClockHealth load() const noexcept {
    ClockHealth health;
    health.source = source_.load(std::memory_order_relaxed);
    health.locked = locked_.load(std::memory_order_relaxed);
    health.offset = Duration{offset_ns_.load(std::memory_order_relaxed)};
    health.jitter = Duration{jitter_ns_.load(std::memory_order_relaxed)};
    health.skew_ppm = skew_ppm_.load(std::memory_order_relaxed);
    health.steps = steps_.load(std::memory_order_relaxed);
    return health;
  }

 private:
  std::atomic<TimeSource> source_{TimeSource::none};
  std::atomic<bool> locked_{false};
  std::atomic<std::int64_t> offset_ns_{0};
  std::atomic<std::int64_t> jitter_ns_{0};
  std::atomic<double> skew_ppm_{0.0};
  std::atomic<std::uint32_t> steps_{0};
};

}  // namespace convexcut::daemon
