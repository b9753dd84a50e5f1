// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "daemon/clock/clock.hpp"

namespace convexcut::daemon {

// The host's clock while a recording is played: runs through the recording's own stamps at a rate.
// At rate `max` it stands at the newest stamp that was delivered, and nobody waits for it. One
// thread starts it.
class PlaybackClock final : public Clock {
 public:
  // rate > 0: recorded seconds per real second; 0: as fast as possible.
  PlaybackClock(double rate, const std::atomic<bool>& stop) noexcept : Clock(stop), rate_(rate) {}

  // Lets `first` be now. Before any other call.
  void start(HostTime first) noexcept;

  [[nodiscard]] bool paced() const noexcept override { return rate_ > 0.0; }
  [[nodiscard]] HostTime now() const noexcept override;
  [[nodiscard]] Steady::time_point steady_at(HostTime time) const noexcept override;
  [[nodiscard]] HostTime host_at(Steady::time_point time) const noexcept override;

  // Rate `max`: a record with this stamp has been delivered.
  void delivered(HostTime stamp) noexcept;

 private:
  double rate_;
  HostTime origin_{};
  Steady::time_point origin_steady_{};
  // Release in delivered(), acquire in now(): whoever sees a stamp here also finds in the rings
  // every record up to it.
  std::atomic<std::int64_t> newest_ns_{0};
};

}  // namespace convexcut::daemon
