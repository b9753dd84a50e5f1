// SPDX-License-Identifier: Apache-2.0
#include "core/clock/hour_clock.hpp"

#include <chrono>
#include <cstdint>

namespace convexcut {
namespace {

using std::chrono::microseconds;

constexpr Duration kHalfHour = kHour / 2;

// The multiple of an hour nearest to `span`.
constexpr Duration nearest_hours(Duration span) noexcept {
  const Duration shifted = span + kHalfHour;
  Duration::rep hours = shifted / kHour;
  if (shifted % kHour < Duration::zero()) --hours;  // division rounds to zero; floor is wanted
  return hours * kHour;
}

static_assert(nearest_hours(std::chrono::minutes{29}) == Duration::zero());
static_assert(nearest_hours(std::chrono::minutes{-31}) == -kHour);
static_assert(nearest_hours(std::chrono::minutes{89}) == kHour);

// to − from, the short way round the hour: (−30 min, +30 min].
constexpr Duration short_way(MicrosPastHour from, MicrosPastHour to) noexcept {
  const Duration ahead =
      microseconds{std::int64_t{to.count} - std::int64_t{from.count}} % kHour;  // (−2 h, 2 h) → 1 h
  if (ahead > kHalfHour) return ahead - kHour;
  if (ahead <= -kHalfHour) return ahead + kHour;
  return ahead;
}

}  // namespace

LidarTime HourClock::unwrap(MicrosPastHour counter, HostTime arrival) noexcept {
  LidarTime time;
  if (last_) {
    const Duration by_sensor = short_way(last_->counter, counter);
    const Duration by_host = arrival - last_->arrival;
    time = last_->time + by_sensor + nearest_hours(by_host - by_sensor);
  } else {
    const Duration past_hour = microseconds{counter.count};
    time = LidarTime{past_hour + nearest_hours(arrival.time_since_epoch() - past_hour)};
  }
  last_ = Reading{counter, time, arrival};
  return time;
}

}  // namespace convexcut
