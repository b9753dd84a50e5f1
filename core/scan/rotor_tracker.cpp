// SPDX-License-Identifier: Apache-2.0
#include "core/scan/rotor_tracker.hpp"

#include <chrono>
#include <cmath>

namespace convexcut {
namespace {

constexpr std::int64_t kTurn = Azimuth::kFullTurn;
// Until the rate is known: the sensor's nominal 10 Hz, half way between its limits of 5 and 20 Hz.
constexpr double kNominalRate = 10.0 * static_cast<double>(kTurn) * 1e-9;
constexpr double kNanosecondsPerSecond = 1e9;

// Within 2 ms even a wrong rate (0 for 20 Hz) puts the rotor off by 14.4°: more is no rotation.
constexpr Duration kGlitchWithin = std::chrono::milliseconds{2};
constexpr std::int64_t kGlitch = 20'000'000;  // microdegrees
constexpr std::uint32_t kMaxGlitches = 24;

// Encoders jitter by more than the step from one firing to the next: the rate is taken from blocks
// of steps, the first of them as soon as it tells anything.
constexpr std::int64_t kFirstBlock = 32;
constexpr std::int64_t kBlock = 64;
constexpr double kSmoothing = 0.25;

// (−half a turn, +half a turn]
std::int64_t short_way(std::int64_t microdegrees) noexcept {
  const std::int64_t turn = Azimuth::from_microdegrees(microdegrees).microdegrees();
  return turn > kTurn / 2 ? turn - kTurn : turn;
}

}  // namespace

std::int64_t RotorTracker::turned(Azimuth azimuth, LidarTime time,
                                  Duration firing_period) noexcept {
  if (!started_) {
    started_ = true;
    turned_ = azimuth.microdegrees();
    time_ = time;
    return turned_;
  }
  const Duration elapsed = time - time_;
  const double rate = rate_known_ ? rate_ : kNominalRate;
  const std::int64_t expected = turned_ + std::llround(rate * static_cast<double>(elapsed.count()));
  const std::int64_t off = short_way(azimuth.microdegrees() - expected);
  const bool impossible = elapsed <= kGlitchWithin && std::abs(off) > kGlitch;
  if (impossible && ++glitches_in_a_row_ <= kMaxGlitches) {
    ++glitches_;
    return expected;
  }
  accept(expected + off, time, glitches_in_a_row_ == 0 ? firing_period : Duration::zero());
  return turned_;
}

double RotorTracker::rate_hz() const noexcept {
  if (!rate_known_) return 0.0;
  return rate_ * kNanosecondsPerSecond / static_cast<double>(kTurn);
}

void RotorTracker::reset() noexcept {
  const std::uint64_t glitches = glitches_;
  *this = RotorTracker{};
  glitches_ = glitches;
}

// `firing_period` zero: not a step that tells of the rate.
void RotorTracker::accept(std::int64_t turned, LidarTime time, Duration firing_period) noexcept {
  const Duration elapsed = time - time_;
  if (elapsed > Duration::zero() && 2 * elapsed < 3 * firing_period) {
    sweep_.microdegrees += turned - turned_;
    sweep_.time += elapsed;
    ++sweep_.steps;
    measure_rate();
  }
  glitches_in_a_row_ = 0;
  turned_ = turned;
  time_ = time;
}

void RotorTracker::measure_rate() noexcept {
  const std::int64_t steps = sweep_.steps - measured_.steps;
  const bool first = measured_.steps == 0;
  if (steps < (first ? kFirstBlock : kBlock)) return;
  const double rate = static_cast<double>(sweep_.microdegrees - measured_.microdegrees) /
                      static_cast<double>((sweep_.time - measured_.time).count());
  // The first block grows until it is whole, the rate with it.
  rate_ = first ? rate : rate_ + kSmoothing * (rate - rate_);
  rate_known_ = true;
  if (steps >= kBlock) measured_ = sweep_;
}

}  // namespace convexcut
