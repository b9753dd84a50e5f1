// SPDX-License-Identifier: Apache-2.0
//
// From a sensor's own clock to the host's, estimated from when its samples arrive.
#pragma once

#include "core/clock/lower_envelope.hpp"
#include "core/time.hpp"

namespace convexcut {

// SensorTime: LidarTime or ImuTime. The estimate, and the error it can have, is described in
// docs/design/time.md; state() tells how good it is. While locked, to_host() of increasing sensor
// times increases, also while the estimate improves; a step of a clock is followed at once (counted
// in ClockState::steps), so what was built on earlier host times (an OrientationTrack) is then to
// be cleared.
//
// One thread. Deterministic. RT: no allocation, no lock, no system call.
template <class SensorTime>
class ClockMapping {
 public:
  explicit ClockMapping(const ClockMappingOptions& options = {}) noexcept : envelope_(options) {}

  // `earliest_possible_host`: the arrival less what must have passed since the sample (the time its
  // bytes took on the line, the time from the first to the last firing of a datagram).
  void observe(SensorTime sensor, HostTime earliest_possible_host) noexcept {
    envelope_.observe(sensor.time_since_epoch(), earliest_possible_host.time_since_epoch());
  }

  // Meaningful after the first observation.
  [[nodiscard]] HostTime to_host(SensorTime sensor) const noexcept {
    return HostTime{envelope_.to_host(sensor.time_since_epoch())};
  }

  [[nodiscard]] ClockState state() const noexcept { return envelope_.state(); }

  void reset() noexcept { envelope_.reset(); }

 private:
  LowerEnvelope envelope_;
};

}  // namespace convexcut
