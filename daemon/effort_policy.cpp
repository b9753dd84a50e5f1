// SPDX-License-Identifier: Apache-2.0
#include "daemon/effort_policy.hpp"

#include <algorithm>

namespace convexcut::daemon {
namespace {

[[nodiscard]] bool waits(const EffortPolicy::Pace& pace, Effort effort) noexcept {
  return pace.learns_first && effort == Effort::full;
}

// After the labels, on the average of the revolutions.
[[nodiscard]] Duration learning(const EffortPolicy::Pace& pace, Effort effort) noexcept {
  return pace.learning / learning_stride(effort);
}

// Without a product that could overflow: some times are as long as they may be.
[[nodiscard]] bool is_calm_share(Duration used, Duration of) noexcept {
  return used < of / 100 * EffortPolicy::kCalmPercent;
}

[[nodiscard]] Effort one_more(Effort effort) noexcept {
  return effort == Effort::full ? effort
                                : static_cast<Effort>(static_cast<std::uint8_t>(effort) - 1);
}

}  // namespace

bool EffortPolicy::is_overrun(const Pace& pace) const noexcept {
  const Duration after = waits(pace, effort_) ? Duration::zero() : learning(pace, effort_);
  return pace.used > pace.budget || pace.used + after > pace.period;
}

bool EffortPolicy::is_calm(const Pace& pace) const noexcept {
  const Effort more = one_more(effort_);
  const Duration in_all = pace.used + learning(pace, more);
  const Duration until_labels = waits(pace, more) ? in_all : pace.used;
  return is_calm_share(until_labels, pace.budget) && is_calm_share(in_all, pace.period);
}

void EffortPolicy::observe(const Pace& pace) noexcept {
  ++since_restored_;
  overruns_ = is_overrun(pace) ? overruns_ + 1 : 0;
  calm_ = is_calm(pace) ? calm_ + 1 : 0;
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
  effort_ = one_more(effort_);
  restored_ = true;
  since_restored_ = 0;
}

}  // namespace convexcut::daemon
