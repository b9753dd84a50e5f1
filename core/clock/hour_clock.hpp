// SPDX-License-Identifier: Apache-2.0
//
// From the lidar's microseconds past the hour to a time that does not wrap.
#pragma once

#include <optional>

#include "core/time.hpp"

namespace convexcut {

// The first value is put into the hour that brings it nearest to the host's stamp, so that the
// result is UTC when the sensor's PPS is locked and the host is right within half an hour. Every
// further value continues from the one before: the count's own difference, taken the short way
// round the hour, plus the whole hours by which the host's elapsed time differs from it (a silence
// of hours; a recording that starts over). A host that is off, or that is corrected by less than
// half an hour, therefore moves nothing. (Wire facts: HDL-32E notes, section 6.)
//
// Host stamps lie in the years 1970 to 2200. One thread. RT: no allocation, no lock, no system
// call.
class HourClock {
 public:
  // `counter`: the whole range is accepted; what overshoots the hour counts as the next one.
  // `arrival`: the host's stamp of the datagram that held it.
  [[nodiscard]] LidarTime unwrap(MicrosPastHour counter, HostTime arrival) noexcept;

  // Forgets the past: the next value is the first.
  void reset() noexcept { last_.reset(); }

 private:
  struct Reading {
    MicrosPastHour counter;
    LidarTime time;
    HostTime arrival;
  };
  std::optional<Reading> last_;
};

}  // namespace convexcut
