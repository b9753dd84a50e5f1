// SPDX-License-Identifier: Apache-2.0
#include "daemon/health/daemon_health.hpp"

#include <algorithm>

namespace convexcut::daemon {
namespace {

DaemonState state_for(std::optional<Severity> worst) noexcept {
  if (!worst) return DaemonState::ok;
  return *worst == Severity::faulty ? DaemonState::faulty : DaemonState::degraded;
}

std::optional<Severity> worst_of(const std::vector<Reason>& reasons) noexcept {
  // They are sorted, worst first.
  return reasons.empty() ? std::nullopt : std::optional(reasons.front().severity);
}

bool is_missing(SourceState state) noexcept {
  return state == SourceState::absent || state == SourceState::waiting;
}

}  // namespace

std::string_view name_of(DaemonState state) noexcept {
  switch (state) {
    case DaemonState::starting:
      return "starting";
    case DaemonState::ok:
      return "ok";
    case DaemonState::degraded:
      return "degraded";
    case DaemonState::faulty:
      return "faulty";
  }
  return "starting";
}

DaemonState next_state(DaemonState before, const DaemonObservation& now,
                       const DaemonLimits& limits) noexcept {
  const DaemonState target = state_for(now.worst);
  if (before == DaemonState::starting) {
    return now.still_starting && target != DaemonState::faulty ? DaemonState::starting : target;
  }
  if (target >= before) return target;  // bad news at once, good news when they have lasted
  return now.calm >= limits.recover_after ? target : before;
}

void DaemonMonitor::update(std::span<const SourceHealth> sources, const HealthCounters& totals,
                           std::span<const Reason> others, SteadyTime now) {
  if (!start_) {
    start_ = last_bad_ = last_result_ = now;
    totals_ = totals;
    last_losses_.resize(kHealthCounters.size());
  }
  watch_results(totals, now);
  watch_losses(totals, now);
  totals_ = totals;

  const bool starting = still_starting(sources, now);
  if (!starting) was_up_ = true;
  std::vector<Reason> found = find_reasons(sources, starting, now);
  found.insert(found.end(), others.begin(), others.end());
  std::stable_sort(found.begin(), found.end(),
                   [](const Reason& a, const Reason& b) { return a.severity > b.severity; });

  const std::optional<Severity> worst = worst_of(found);
  if (state_for(worst) >= state_) last_bad_ = now;
  const DaemonState before = state_;
  state_ = next_state(before, {starting, worst, now - last_bad_}, limits_);
  if (state_ != before) last_bad_ = now;
  // A state that is only held keeps its reasons.
  if (state_for(worst) == state_ || state_ == DaemonState::starting) reasons_ = std::move(found);
}

bool DaemonMonitor::still_starting(std::span<const SourceHealth> sources, SteadyTime now) const {
  if (was_up_ || now - *start_ >= limits_.start_grace) return false;
  return std::any_of(sources.begin(), sources.end(), [](const SourceHealth& source) {
    return source.required && is_missing(source.state);
  });
}

std::vector<Reason> DaemonMonitor::find_reasons(std::span<const SourceHealth> sources,
                                                bool starting, SteadyTime now) const {
  std::vector<Reason> found;
  for (const SourceHealth& source : sources) {
    if (source.lost_hz > limits_.lossy_share * (source.valid_hz + source.lost_hz)) {
      found.push_back({Severity::degraded, source.name + " losing input"});
    }
    if (source.state == SourceState::streaming) continue;
    const bool may_still_come = starting && is_missing(source.state);
    found.push_back({source.required && !may_still_come ? Severity::faulty : Severity::degraded,
                     source.name + " " + std::string(name_of(source.state))});
  }
  if (now - last_result_ > limits_.silent_after) {
    found.push_back({Severity::faulty, "no results published"});
  }
  for (std::size_t i = 0; i < kHealthCounters.size(); ++i) {
    if (last_losses_[i] && now - *last_losses_[i] <= limits_.loss_hold) {
      found.push_back({Severity::degraded, std::string(kHealthCounters[i].loss)});
    }
  }
  return found;
}

void DaemonMonitor::watch_results(const HealthCounters& totals, SteadyTime now) {
  if (totals.results != totals_.results) last_result_ = now;
}

void DaemonMonitor::watch_losses(const HealthCounters& totals, SteadyTime now) {
  for (std::size_t i = 0; i < kHealthCounters.size(); ++i) {
    const CounterInfo& counter = kHealthCounters[i];
    if (!counter.loss.empty() && totals.*counter.value != totals_.*counter.value) {
      last_losses_[i] = now;
    }
  }
}

}  // namespace convexcut::daemon
