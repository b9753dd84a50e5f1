// SPDX-License-Identifier: Apache-2.0
#include "daemon/effort_policy.hpp"

#include <algorithm>

namespace convexcut::daemon {

void EffortPolicy::observe(Duration used, Duration budget) noexcept {
  ++since_restored_;
  const bool overrun = used > budget;
  const bool calm = used * 100 < budget * kCalmPercent;
  overruns_ = overrun ? overruns_ + 1 : 0;
  calm_ = calm ? calm_ + 1 : 0;
  if (overruns_ >= kOverruns) {
    reduce();
  } else if (calm_ >= calm_wanted_) {
    restore();
  }
}

void EffortPolicy::reduce() noexcept {
  overruns_ = calm_ = 0;
  if (effort_ == kLeastEffort) return;
  effort_ = static_cast<Effort>(static_cast<std::uint8_t>(effort_) + 1);
  const bool step_up_failed = restored_ && since_restored_ <= calm_wanted_;
  calm_wanted_ = step_up_failed ? std::min(calm_wanted_ * 2, kLongestCalm) : kShortestCalm;
  restored_ = false;
}

void EffortPolicy::restore() noexcept {
  calm_ = 0;
  if (effort_ == Effort::full) return;
  effort_ = static_cast<Effort>(static_cast<std::uint8_t>(effort_) - 1);
  restored_ = true;
  since_restored_ = 0;
}

}  // namespace convexcut::daemon
