// SPDX-License-Identifier: Apache-2.0
//
// How far the lidar's rotor has turned in all, from azimuths that wrap, jitter and have gaps.
#pragma once

#include <cstdint>

#include "core/angle.hpp"
#include "core/time.hpp"

namespace convexcut {

// The angle turned in steps from one firing to the next, gaps left out: the mean step of a stretch
// is the difference of two of these.
struct Sweep {
  std::int64_t microdegrees = 0;
  std::int64_t steps = 0;
  Duration time{};
};

// Counts turns: an azimuth is taken as the one that is nearest to where the rotor should be by the
// sensor's time and the rotor's rate. That holds through any gap in which the rate's error makes
// less than half a turn. A single azimuth that cannot be true (bit error, encoder slip) is replaced
// by the expected one; when it persists, it is believed.
//
// One thread. RT: no allocation, no lock, no system call.
class RotorTracker {
 public:
  // Microdegrees turned since azimuth 0 of the first turn; grows clockwise, and falls when the
  // encoder or the rotor goes back. `time` never decreases; `firing_period` > 0.
  [[nodiscard]] std::int64_t turned(Azimuth azimuth, LidarTime time,
                                    Duration firing_period) noexcept;

  // Revolutions a second; 0 until some 30 firings have been seen.
  [[nodiscard]] double rate_hz() const noexcept;
  [[nodiscard]] const Sweep& sweep() const noexcept { return sweep_; }
  [[nodiscard]] std::uint64_t glitches() const noexcept { return glitches_; }
  // Forgets everything but glitches(): the next firing is the first.
  void reset() noexcept;

 private:
  void accept(std::int64_t turned, LidarTime time, Duration firing_period) noexcept;
  void measure_rate() noexcept;

  bool started_ = false;
  std::int64_t turned_ = 0;  // at the last believed azimuth
  LidarTime time_{};         // of it
  bool rate_known_ = false;
  double rate_ = 0.0;  // microdegrees a nanosecond
  Sweep sweep_;
  Sweep measured_;  // the sweep up to which the rate was measured
  std::uint32_t glitches_in_a_row_ = 0;
  std::uint64_t glitches_ = 0;
};

}  // namespace convexcut
