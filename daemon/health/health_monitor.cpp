// SPDX-License-Identifier: Apache-2.0
#include "daemon/health/health_monitor.hpp"

#include <utility>

namespace convexcut::daemon {
namespace {

Duration stretched(Duration span, double pace) noexcept {
  return std::chrono::duration_cast<Duration>(span / pace);
}

}  // namespace

StageSummary summary_of(const LatencyHistogram& histogram) noexcept {
  StageSummary summary;
  summary.count = histogram.count();
  summary.total = histogram.total();
  summary.p50 = histogram.percentile(50.0);
  summary.p99 = histogram.percentile(99.0);
  summary.p999 = histogram.percentile(99.9);
  summary.max = histogram.max();
  return summary;
}

std::string joined(const std::vector<Reason>& reasons) {
  std::string text;
  for (const Reason& reason : reasons) {
    if (!text.empty()) text += "; ";
    text += reason.text;
  }
  return text;
}

HealthMonitor::HealthMonitor(const StageHistograms& stages, double pace)
    : stages_(stages),
      source_limits_({.stale_after = stretched(SourceLimits{}.stale_after, pace)}),
      daemon_({.silent_after = stretched(DaemonLimits{}.silent_after, pace)}) {}

void HealthMonitor::add_source(std::string name, bool required, ReadSource read) {
  sources_.push_back({SourceMonitor(std::move(name), required, source_limits_), std::move(read)});
}

void HealthMonitor::add_clock(std::string name, const ClockGauge& gauge) {
  clocks_.push_back({std::move(name), &gauge});
}

void HealthMonitor::poll(SteadyTime now, const HealthCounters& totals,
                         const std::vector<Reason>& others) {
  if (!start_) start_ = now;
  totals_ = totals;
  health_.clear();
  for (Source& source : sources_) health_.push_back(source.monitor.update(source.read(), now));
  daemon_.update(health_, totals, others, now);
}

HealthSnapshot HealthMonitor::snapshot(HostTime stamp, SteadyTime now) const {
  HealthSnapshot snapshot;
  snapshot.stamp = stamp;
  if (start_) snapshot.uptime = now - *start_;
  snapshot.state = daemon_.state();
  snapshot.reasons = daemon_.reasons();
  snapshot.sources = health_;
  for (const Clock& clock : clocks_) snapshot.clocks.push_back({clock.name, clock.gauge->load()});
  for (const StageInfo& stage : kStages) {
    snapshot.stages[static_cast<std::size_t>(stage.stage)] = summary_of(stages_.of(stage.stage));
  }
  snapshot.totals = totals_;
  return snapshot;
}

}  // namespace convexcut::daemon
