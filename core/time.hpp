// SPDX-License-Identifier: Apache-2.0
//
// Time as it crosses interfaces: int64 nanoseconds, one type per clock, so that a sensor's time can
// never be taken for the host's by accident. Nothing in core/ reads a clock.
#pragma once

#include <chrono>
#include <cstdint>
#include <ratio>

namespace convexcut {

using Duration = std::chrono::nanoseconds;
static_assert(sizeof(Duration::rep) == 8, "durations are int64 nanoseconds");

namespace detail {
// A clock that is only a name: time points of it come from sensors, kernels and recordings.
template <class Tag>
struct NamedClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<NamedClock>;
  static constexpr bool is_steady = false;
};
}  // namespace detail

// The host's Unix-epoch clock (kernel socket stamps, capture records). The common clock of the
// system.
using HostTime = std::chrono::time_point<detail::NamedClock<struct HostClockTag>, Duration>;

// The lidar's own counter after unwrapping the hour. Increases with the sensor, its zero is
// arbitrary unless PPS is locked, when it is UTC.
using LidarTime = std::chrono::time_point<detail::NamedClock<struct LidarClockTag>, Duration>;

// The IMU's own counter after unwrapping (SampleTimeFine over serial, SampleTime over CAN). Its
// zero is arbitrary.
using ImuTime = std::chrono::time_point<detail::NamedClock<struct ImuClockTag>, Duration>;

// What the lidar sends: microseconds past the hour, 0 … 3 599 999 999 (a few sensors have been seen
// to overshoot slightly before they wrap: HDL-32E notes, section 6).
struct MicrosPastHour {
  std::uint32_t count = 0;
  friend constexpr bool operator==(MicrosPastHour, MicrosPastHour) = default;
};

inline constexpr Duration kHour = std::chrono::hours{1};

template <class Time>
[[nodiscard]] constexpr Time from_ns(std::int64_t ns_since_epoch) noexcept {
  return Time{Duration{ns_since_epoch}};
}

template <class Clock>
[[nodiscard]] constexpr std::int64_t to_ns(std::chrono::time_point<Clock, Duration> t) noexcept {
  return t.time_since_epoch().count();
}

}  // namespace convexcut
