// SPDX-License-Identifier: Apache-2.0
#include "daemon/result_grid.hpp"

namespace convexcut::daemon {
namespace {

// Of a period, in percent.
constexpr int kShortest = 89;
constexpr int kLongest = 111;

}  // namespace

void ResultGrid::start(HostTime now) noexcept {
  instant_ = now + period_;
  locked_ = false;
}

HostTime ResultGrid::oldest_end() const noexcept {
  return locked_ ? instant_ - period_ / 2 : HostTime::min();
}

void ResultGrid::advance_with_scan(HostTime last_firing, Duration scan_period) noexcept {
  locked_ = follows(scan_period);
  if (!locked_) {
    instant_ += period_;
    return;
  }
  HostTime next = last_firing + scan_period;
  // A scan that is older than its instant (the grid was free until now, or the scan was late).
  if (next <= instant_) next += ((instant_ - next) / scan_period + 1) * scan_period;
  instant_ = next;
}

void ResultGrid::advance() noexcept {
  locked_ = false;
  instant_ += period_;
}

std::uint64_t ResultGrid::catch_up(HostTime now) noexcept {
  if (now < instant_ + period_) return 0;
  const auto missed = (now - instant_) / period_;
  instant_ += missed * period_;
  return static_cast<std::uint64_t>(missed);
}

bool ResultGrid::follows(Duration scan_period) const noexcept {
  return scan_period * 100 >= period_ * kShortest && scan_period * 100 <= period_ * kLongest;
}

}  // namespace convexcut::daemon
