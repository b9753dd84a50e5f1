// SPDX-License-Identifier: Apache-2.0
#include "core/clock/lower_envelope.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

namespace convexcut {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Sensors are seen to repeat times tens of milliseconds old; what goes back further has restarted.
constexpr Duration kSensorRestart = seconds{1};
constexpr std::uint32_t kWindowsOfAStep = 3;
constexpr std::size_t kWindowsToFit = 8;
// A better estimate is approached at this rate, so that the mapped time neither jumps nor runs
// backwards; a correction that would take longer than 20 s is made at once.
constexpr double kSlew = 100e-6;
constexpr Duration kMaxSlewed = milliseconds{2};

double ns(Duration d) noexcept { return static_cast<double>(d.count()); }
Duration from_double_ns(double value) noexcept { return Duration{std::llround(value)}; }

}  // namespace

Duration LowerEnvelope::Line::at(Duration sensor) const noexcept {
  return through.offset + from_double_ns(skew * ns(sensor - through.sensor));
}

void LowerEnvelope::observe(Duration sensor, Duration host) noexcept {
  const Observation o{sensor, host - sensor};
  ++samples_;
  if (samples_ == 1) return restart(o);

  const bool restarted = sensor < newest_ - kSensorRestart;
  if (restarted || estimate_.below(o) < -options_.step) {
    ++steps_;
    return restart(o);
  }
  slew(sensor);
  if (estimate_.below(o) < Duration::zero()) move_to({o, estimate_.skew});
  if (sensor >= open_.start + options_.window && !close_window(sensor)) {
    ++steps_;
    return restart(o);
  }
  add_to_window(o, estimate_.below(o));
}

Duration LowerEnvelope::to_host(Duration sensor) const noexcept {
  return sensor + estimate_.at(sensor) + correction_;
}

ClockState LowerEnvelope::state() const noexcept {
  double squared_delays = open_.squared_delays;
  std::uint64_t samples = open_.samples;
  for (std::size_t i = 0; i < closed_count_; ++i) {
    squared_delays += closed(i).squared_delays;
    samples += closed(i).samples;
  }
  const double mean = samples == 0 ? 0.0 : squared_delays / static_cast<double>(samples);
  return {.offset = estimate_.at(newest_) + correction_,
          .skew_ppm = estimate_.skew * 1e6,
          .jitter = from_double_ns(std::sqrt(mean)),
          .samples = samples_,
          .steps = steps_,
          .locked = locked_};
}

// The skew outlives a step: the crystals are the same.
void LowerEnvelope::restart(const Observation& first) noexcept {
  closed_count_ = 0;
  windows_above_ = 0;
  locked_ = false;
  estimate_ = {first, estimate_.skew};
  correction_ = Duration::zero();
  newest_ = first.sensor;
  open_ = {.start = first.sensor, .lowest = first, .squared_delays = 0.0, .samples = 1};
}

void LowerEnvelope::slew(Duration sensor) noexcept {
  if (sensor <= newest_) return;
  const Duration most = from_double_ns(kSlew * ns(sensor - newest_));
  correction_ -= std::clamp(correction_, -most, most);
  newest_ = sensor;
}

void LowerEnvelope::add_to_window(const Observation& o, Duration delay) noexcept {
  if (o.sensor < open_.start) return;  // a repeated old time; the hull needs them in order
  if (open_.samples == 0 || delay < estimate_.below(open_.lowest)) open_.lowest = o;
  open_.squared_delays += ns(delay) * ns(delay);
  ++open_.samples;
}

bool LowerEnvelope::close_window(Duration now) noexcept {
  windows_above_ = estimate_.below(open_.lowest) > options_.step ? windows_above_ + 1 : 0;
  if (windows_above_ >= kWindowsOfAStep) return false;

  if (closed_count_ == kWindows) {
    oldest_ = (oldest_ + 1) % kWindows;
    --closed_count_;
  }
  closed_[(oldest_ + closed_count_) % kWindows] = open_;
  ++closed_count_;
  const Duration horizon = now - options_.window * static_cast<Duration::rep>(kWindows);
  while (closed_count_ > 0 && closed(0).start < horizon) {
    oldest_ = (oldest_ + 1) % kWindows;
    --closed_count_;
  }
  fit();
  open_ = {.start = now, .lowest = {}, .squared_delays = 0.0, .samples = 0};
  return true;
}

void LowerEnvelope::fit() noexcept {
  if (closed_count_ == 0) return;  // a long silence: the old line is the best there is
  Line line{closed(closed_count_ - 1).lowest, estimate_.skew};
  const Duration span = line.through.sensor - closed(0).lowest.sensor;
  const bool enough = closed_count_ >= kWindowsToFit && span >= options_.min_span;
  if (enough) {
    const double limit = options_.max_skew_ppm * 1e-6;
    line.skew = std::clamp(slope_under_the_middle(), -limit, limit);
  }
  Duration lowest = Duration::zero();
  for (std::size_t i = 0; i < closed_count_; ++i) {
    lowest = std::min(lowest, line.below(closed(i).lowest));
  }
  line.through.offset += lowest;
  move_to(line);
  locked_ = locked_ || enough;
}

// What was told so far goes on without a jump, once it is worth relying on.
void LowerEnvelope::move_to(const Line& estimate) noexcept {
  correction_ += estimate_.at(newest_) - estimate.at(newest_);
  if (!locked_ || std::chrono::abs(correction_) > kMaxSlewed) correction_ = Duration::zero();
  estimate_ = estimate;
}

double LowerEnvelope::slope_under_the_middle() const noexcept {
  // Andrew's monotone chain, lower half: the windows are already in the order of their time.
  std::array<Observation, kWindows> hull;
  std::size_t size = 0;
  const Observation origin = closed(0).lowest;
  const auto turns_down = [&](const Observation& a, const Observation& b, const Observation& c) {
    return ns(b.sensor - a.sensor) * ns(c.offset - a.offset) <=
           ns(b.offset - a.offset) * ns(c.sensor - a.sensor);
  };
  for (std::size_t i = 0; i < closed_count_; ++i) {
    const Observation& next = closed(i).lowest;
    while (size >= 2 && turns_down(hull[size - 2], hull[size - 1], next)) --size;
    hull[size++] = next;
  }
  const Duration middle = origin.sensor + (hull[size - 1].sensor - origin.sensor) / 2;
  std::size_t right = 1;
  while (right + 1 < size && hull[right].sensor < middle) ++right;
  const Observation& a = hull[right - 1];
  const Observation& b = hull[right];
  return ns(b.offset - a.offset) / ns(b.sensor - a.sensor);
}

}  // namespace convexcut
