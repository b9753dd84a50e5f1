// SPDX-License-Identifier: Apache-2.0
//
// A device's 32-bit sample time, unwrapped into one ImuTime that runs on.
#pragma once

#include <chrono>
#include <cstdint>

#include "core/time.hpp"

namespace convexcut::xsens {

// Each value is placed next to the one before it. Values may come a little out of order (GNSS
// messages of an MTi-G are up to 50 ms older than their neighbours, also across a wrap); a step
// back by more than half the shortest wrap is a wrap, any other step back is a step back (a device
// that restarted). One thread. RT.
class SampleClock {
 public:
  // SampleTimeFine over serial: 100 µs. The Xsens SDK wraps it after a day, the field would after
  // 2^32; which of the two a step back is follows from where it leads.
  [[nodiscard]] static constexpr SampleClock sample_time_fine() noexcept {
    return {std::chrono::microseconds{100}, 864'000'000};
  }
  // SampleTime over CAN: 1 µs, wraps at 2^32 (71.6 min).
  [[nodiscard]] static constexpr SampleClock can_sample_time() noexcept {
    return {std::chrono::microseconds{1}, kFieldWrap};
  }

  constexpr ImuTime unwrap(std::uint32_t ticks) noexcept {
    if (started_) {
      unwrapped_ += step(static_cast<std::int64_t>(ticks) - last_);
    }
    // Only a stream of nonsense runs this far; starting over keeps the arithmetic defined.
    if (!started_ || unwrapped_ > kFarthest / tick_.count() ||
        unwrapped_ < -kFarthest / tick_.count()) {
      unwrapped_ = ticks;
      started_ = true;
    }
    last_ = ticks;
    return ImuTime{unwrapped_ * tick_};
  }

 private:
  static constexpr std::int64_t kFieldWrap = std::int64_t{1} << 32;
  static constexpr std::int64_t kFarthest = std::int64_t{1} << 62;  // ns, 146 years
  static constexpr Duration kOutOfOrder = std::chrono::seconds{10};

  constexpr SampleClock(Duration tick, std::int64_t device_wrap) noexcept
      : tick_(tick), device_wrap_(device_wrap) {}

  // The true step, in ticks, where the raw values differ by `difference`.
  [[nodiscard]] constexpr std::int64_t step(std::int64_t difference) const noexcept {
    if (difference < -device_wrap_ / 2) {
      const std::int64_t by_device = difference + device_wrap_;
      const std::int64_t by_field = difference + kFieldWrap;
      return magnitude(by_device) < magnitude(by_field) ? by_device : by_field;
    }
    for (const std::int64_t wrap : {device_wrap_, kFieldWrap}) {  // late, from before the wrap
      const std::int64_t back = difference - wrap;
      if (back < 0 && back * tick_ >= -kOutOfOrder) return back;
    }
    return difference;
  }
  [[nodiscard]] static constexpr std::int64_t magnitude(std::int64_t value) noexcept {
    return value < 0 ? -value : value;
  }

  Duration tick_;
  std::int64_t device_wrap_;
  std::int64_t last_ = 0;
  std::int64_t unwrapped_ = 0;  // ticks
  bool started_ = false;
};

}  // namespace convexcut::xsens
