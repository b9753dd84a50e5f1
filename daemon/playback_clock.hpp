// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include "core/time.hpp"

namespace convexcut::daemon {

// The host's clock while a recording is played: runs through the recording's own stamps at a rate.
// At rate `max` it stands at the newest stamp that was delivered, and nobody waits for it. Any
// thread may read it and wait for it; one thread starts it.
class PlaybackClock {
 public:
  // rate > 0: recorded seconds per real second; 0: as fast as possible.
  PlaybackClock(double rate, const std::atomic<bool>& stop) : rate_(rate), stop_(stop) {}

  // Lets `first` be now. Before any other call.
  void start(HostTime first) noexcept;

  [[nodiscard]] bool paced() const noexcept { return rate_ > 0.0; }
  [[nodiscard]] HostTime now() const noexcept;
  // Returns at `time`, at once at rate `max`, and soon after a stop.
  void wait_until(HostTime time) const noexcept;
  // Sleeps a span of the recording's time (of real time at rate `max`).
  void pause(Duration span) const noexcept;

  // Rate `max`: a record with this stamp has been delivered.
  void delivered(HostTime stamp) noexcept;

 private:
  using Steady = std::chrono::steady_clock;

  double rate_;
  const std::atomic<bool>& stop_;
  HostTime origin_{};
  Steady::time_point origin_steady_{};
  // Release in delivered(), acquire in now(): whoever sees a stamp here also finds in the rings
  // every record up to it.
  std::atomic<std::int64_t> newest_ns_{0};
};

}  // namespace convexcut::daemon
