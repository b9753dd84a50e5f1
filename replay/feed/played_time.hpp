// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/time.hpp"

namespace convexcut::replay {

// When things happen that were recorded: a recording that is played at a rate, time after time.
//
// A sensor's clock gains a second in a second whatever its data are used for. So the times inside
// its packets are played as well: at twice the rate it has half of the recorded time between two
// packets, and the second time around it goes on from where the first one ended.
struct PlayedTime {
  double rate = 1.0;       // recorded seconds per second
  Duration loop_length{};  // of the recording
  std::uint64_t loop = 0;  // how many times it has been played to its end

  // From the first start to what came `recorded` after the beginning of the recording.
  [[nodiscard]] Duration operator()(Duration recorded) const noexcept {
    const Duration total = recorded + loop_length * static_cast<std::int64_t>(loop);
    if (rate == 1.0) return total;  // exactly
    return Duration{static_cast<Duration::rep>(static_cast<double>(total.count()) / rate)};
  }
  // What a device's time that had gained `gained` since its first record is moved by.
  [[nodiscard]] Duration shift(Duration gained) const noexcept { return (*this)(gained)-gained; }
};

}  // namespace convexcut::replay
