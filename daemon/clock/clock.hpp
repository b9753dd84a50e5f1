// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>

#include "core/time.hpp"

namespace convexcut::daemon {

// The host's time as the worker and the publishers see it: the host's own clock when the input is
// live, the recording's when one is played. Waiting is on CLOCK_MONOTONIC up to an absolute time,
// so that neither a step of the host's clock nor the time between deciding and sleeping moves the
// end of a wait.
//
// Any thread, after start-up. RT: no allocation, no lock.
class Clock {
 public:
  using Steady = std::chrono::steady_clock;  // CLOCK_MONOTONIC

  // `stop` ends every wait; it outlives the clock.
  explicit Clock(const std::atomic<bool>& stop) noexcept : stop_(stop) {}
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  // False when time passes as fast as the data can be processed: then nobody waits.
  [[nodiscard]] virtual bool paced() const noexcept { return true; }
  [[nodiscard]] virtual HostTime now() const noexcept = 0;

  // When `time` is, on CLOCK_MONOTONIC, and the other way round. Only while paced.
  [[nodiscard]] virtual Steady::time_point steady_at(HostTime time) const noexcept = 0;
  [[nodiscard]] virtual HostTime host_at(Steady::time_point time) const noexcept = 0;

  // Worker thread: follows the host's clock. How far it was set since the last call; 0 nearly
  // always. All times from before are then older by as much.
  [[nodiscard]] virtual Duration take_step() noexcept { return Duration::zero(); }

  // Returns at `time`, at once when it has passed or time is not paced, and soon after a stop.
  void wait_until(HostTime time) const noexcept;
  void wait_until(Steady::time_point time) const noexcept;
  // Waits for a span of this clock's time (of real time when it is not paced).
  void pause(Duration span) const noexcept;

 protected:
  // All waiting ends in this. A clock of tests lets time pass here.
  virtual void sleep_until(Steady::time_point time) const noexcept;

 private:
  const std::atomic<bool>& stop_;
};

}  // namespace convexcut::daemon
