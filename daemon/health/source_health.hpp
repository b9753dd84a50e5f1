// SPDX-License-Identifier: Apache-2.0
//
// How a live source is doing: what its link says of itself and what its driver makes of the bytes,
// as one of five states. State table: docs/design/health.md.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/time.hpp"
#include "drivers/live/live_source.hpp"

namespace convexcut::daemon {

// Spans between moments are measured on the clock that nobody sets.
using SteadyTime = std::chrono::steady_clock::time_point;

enum class SourceState : std::uint8_t {
  absent,     // no device or interface; it is looked for again and again
  waiting,    // open, nothing valid since
  streaming,  // valid input comes
  stale,      // it came and has stopped
  faulty,     // the device reports errors, input is mostly invalid, or opening is refused
};
inline constexpr int kSourceStates = 5;

[[nodiscard]] std::string_view name_of(SourceState state) noexcept;

// Entering and leaving differ, so that a source on the border does not flicker.
struct SourceLimits {
  Duration stale_after = std::chrono::milliseconds{300};  // without valid input
  Duration recover_after = std::chrono::seconds{1};       // of valid input, from stale or faulty
  double faulty_share = 0.5;      // of the input is invalid: faulty from here …
  double recovered_share = 0.1;   // … until it is no more than this
  double least_invalid_hz = 5.0;  // below, invalid input is an accident
};

// What is known of a source at one moment.
struct SourceObservation {
  live::LinkState link = live::LinkState::closed;
  int last_error = 0;                   // errno, 0: none
  std::optional<Duration> since_valid;  // since the last valid input; nothing: there was none yet
  Duration valid_for{};                 // valid input without a gap of stale_after until now
  double valid_hz = 0.0;
  double invalid_hz = 0.0;
};

// The transition, free of time and memory.
[[nodiscard]] SourceState next_state(SourceState before, const SourceObservation& now,
                                     const SourceLimits& limits) noexcept;

// What a source says at a moment: its link, and totals since the start.
struct SourceReading {
  live::LinkState link = live::LinkState::closed;
  int last_error = 0;
  std::uint64_t valid = 0;    // packets, messages or frames that were understood
  std::uint64_t invalid = 0;  // that were not
  std::uint64_t lost = 0;     // that never came, as the sensor's own counting shows
};

struct SourceHealth {
  std::string name;       // "lidar", "imu", "can"
  bool required = false;  // without it there are no results
  SourceState state = SourceState::absent;
  SourceReading reading;
  std::optional<Duration> since_valid;
  double valid_hz = 0.0;
  double invalid_hz = 0.0;
  double lost_hz = 0.0;
};

// Follows one source. One thread; to be called several times within stale_after, since what came
// between two calls counts as having come at the second.
class SourceMonitor {
 public:
  SourceMonitor(std::string name, bool required, const SourceLimits& limits = {})
      : limits_(limits) {
    health_.name = std::move(name);
    health_.required = required;
  }

  const SourceHealth& update(const SourceReading& reading, SteadyTime now);
  [[nodiscard]] const SourceHealth& health() const noexcept { return health_; }

 private:
  void measure_rates(SteadyTime now) noexcept;

  SourceLimits limits_;
  SourceHealth health_;
  std::optional<SteadyTime> last_valid_;
  SteadyTime valid_since_{};
  // The window over which rates are measured.
  std::optional<SteadyTime> window_start_;
  SourceReading window_;  // at its start
};

}  // namespace convexcut::daemon
