// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/counter.hpp"

namespace convexcut::xsens {

// Counts the steps that a device's 16-bit counter (PacketCounter, GroupCounter) leaves out. A step
// that is zero or back, i.e. half the range or more ahead, is no loss but a device that started
// over. One thread. RT.
class LossCounter {
 public:
  // The counters outlive this.
  LossCounter(Counter& lost, Counter& restarts) noexcept : lost_(lost), restarts_(restarts) {}

  void on_count(std::uint16_t count) noexcept {
    const auto missing = static_cast<std::uint16_t>(count - last_ - 1);  // modulo 65536
    if (started_ && missing >= kHalfRange) restarts_.add();
    if (started_ && missing < kHalfRange && missing != 0) lost_.add(missing);
    last_ = count;
    started_ = true;
  }

 private:
  static constexpr std::uint16_t kHalfRange = 32768;

  Counter& lost_;
  Counter& restarts_;
  std::uint16_t last_ = 0;
  bool started_ = false;
};

}  // namespace convexcut::xsens
