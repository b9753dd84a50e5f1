// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/time.hpp"

namespace convexcut::daemon {

// The instants of the worker's results: each has exactly one, a scan or an empty one. The grid is
// locked to the sensor while scans end at nearly its own period (0.90 … 1.13 of it: a rotor of 9 to
// 11 Hz, and measurement error): an instant then is the expected last firing of a scan. Otherwise
// it runs on freely at its period, without drift. Design note: docs/design/realtime.md.
//
// Pure: reads no clock. One thread.
class ResultGrid {
 public:
  // period > 0.
  explicit ResultGrid(Duration period) noexcept : period_(period) {}

  // The first instant is one period after `now`.
  void start(HostTime now) noexcept;

  [[nodiscard]] HostTime instant() const noexcept { return instant_; }
  [[nodiscard]] Duration period() const noexcept { return period_; }
  [[nodiscard]] bool locked() const noexcept { return locked_; }
  // What ended before is the scan of an earlier instant.
  [[nodiscard]] HostTime oldest_end() const noexcept;

  // The instant had a scan, which ended at `last_firing`; `scan_period` from there to the end of
  // the next one, 0 when unknown.
  void advance_with_scan(HostTime last_firing, Duration scan_period) noexcept;
  // The instant had none: the grid runs freely.
  void advance() noexcept;
  // Leaves out the instants that are more than a period past; how many.
  std::uint64_t catch_up(HostTime now) noexcept;
  // The clock was set by `step`.
  void shift(Duration step) noexcept { instant_ += step; }

 private:
  [[nodiscard]] bool follows(Duration scan_period) const noexcept;

  Duration period_;
  HostTime instant_{};
  bool locked_ = false;
  bool had_scan_ = false;  // the instant before
};

}  // namespace convexcut::daemon
