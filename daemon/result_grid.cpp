// SPDX-License-Identifier: Apache-2.0
#include "daemon/result_grid.hpp"

namespace convexcut::daemon {
namespace {

// Of a period, in percent: 11.1 and 8.85 Hz for one of 100 ms.
constexpr int kShortest = 90;
constexpr int kLongest = 113;

}  // namespace

void ResultGrid::start(HostTime now) noexcept {
  instant_ = now + period_;
  locked_ = had_scan_ = false;
}

HostTime ResultGrid::oldest_end() const noexcept {
  return locked_ ? instant_ - period_ / 2 : HostTime::min();
}

void ResultGrid::advance_with_scan(HostTime last_firing, Duration scan_period) noexcept {
  const bool was_free = !locked_ && had_scan_;
  locked_ = follows(scan_period);
  had_scan_ = true;
  if (!locked_) {
    instant_ += period_;
    return;
  }
  // The first end of a scan after this instant. Where the grid ran freely beside a sensor, the one
  // that is nearest to a period away: locking shall not add results.
  const HostTime after = was_free ? instant_ + period_ / 2 : instant_;
  HostTime next = last_firing + scan_period;
  if (next <= after) next += ((after - next) / scan_period + 1) * scan_period;
  instant_ = next;
}

void ResultGrid::advance() noexcept {
  locked_ = had_scan_ = false;
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
