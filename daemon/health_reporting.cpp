// SPDX-License-Identifier: Apache-2.0
#include "daemon/health_reporting.hpp"

#include <utility>

#include "daemon/health/prometheus.hpp"

namespace convexcut::daemon {
namespace {

std::unique_ptr<MetricsServer> make_server(const config::Metrics& settings) {
  if (settings.port == 0) return nullptr;
  return std::make_unique<MetricsServer>(
      MetricsServerOptions{.address = settings.address, .port = settings.port},
      kPrometheusContentType);
}

}  // namespace

HealthReporting::HealthReporting(const Participant& participant, const config::Config& config,
                                 Inputs& inputs, const SequencerCounters& lidar_packets,
                                 const WorkerReport& report, std::vector<Reason> problems,
                                 Totals totals)
    : inputs_(inputs),
      problems_(std::move(problems)),
      totals_(std::move(totals)),
      monitor_(report.stages, inputs.pace()),
      publisher_(participant, config.dds),
      metrics_(make_server(config.metrics)) {
  inputs.add_sources(monitor_, lidar_packets);
  monitor_.add_clock("lidar", report.lidar_clock);
  monitor_.add_clock("imu", report.imu_clock);
}

void HealthReporting::poll() {
  // That nothing comes after the end of a recording is no fault. Relaxed: nothing is read by it.
  if (inputs_.lidar_ended().load(std::memory_order_relaxed)) return;
  monitor_.poll(SteadyTime::clock::now(), totals_(), problems_);
}

HealthSnapshot HealthReporting::snapshot() const {
  return monitor_.snapshot(inputs_.clock().now(), SteadyTime::clock::now());
}

void HealthReporting::report() {
  const HealthSnapshot now = snapshot();
  write(changes_.lines(now));
  publisher_.publish(now);
  if (metrics_) metrics_->show(prometheus_text(now));
}

void HealthReporting::dump() const { write(detail_lines(snapshot())); }

}  // namespace convexcut::daemon
