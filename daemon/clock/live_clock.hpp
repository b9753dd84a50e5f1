// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/counter.hpp"
#include "daemon/clock/clock.hpp"

namespace convexcut::daemon {

// The host's own clock, which the kernel stamps what it receives with: CLOCK_REALTIME, told as
// CLOCK_MONOTONIC plus the offset between them. NTP slews both alike, so the offset only changes
// when somebody sets the clock (settimeofday, a leap second). now() follows such a step when the
// worker has taken it, and never moves back otherwise.
class LiveClock final : public Clock {
 public:
  // Smaller changes are taken without a word: nothing that is built on host times notices.
  static constexpr Duration kSmallestStep = std::chrono::milliseconds{5};

  // One reading of CLOCK_REALTIME − CLOCK_MONOTONIC. Tests have one of their own.
  using ReadOffset = Duration (*)() noexcept;

  explicit LiveClock(const std::atomic<bool>& stop, ReadOffset read = &read_offset) noexcept;

  [[nodiscard]] HostTime now() const noexcept override { return host_at(Steady::now()); }
  [[nodiscard]] Steady::time_point steady_at(HostTime time) const noexcept override;
  [[nodiscard]] HostTime host_at(Steady::time_point time) const noexcept override;
  [[nodiscard]] Duration take_step() noexcept override;

  // Steps taken so far. Any thread; a step is followed by now() before it is counted here.
  [[nodiscard]] std::uint64_t steps() const noexcept { return steps_.value(); }

  // RT: a few calls of the vDSO.
  [[nodiscard]] static Duration read_offset() noexcept;

 private:
  [[nodiscard]] Duration offset() const noexcept;

  ReadOffset read_;
  // Written by the worker, read by all. Relaxed on both sides: it is a value on its own, nothing
  // else is published with it.
  std::atomic<std::int64_t> offset_ns_;
  Counter steps_;
};

}  // namespace convexcut::daemon
