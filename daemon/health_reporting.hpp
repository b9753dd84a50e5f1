// SPDX-License-Identifier: Apache-2.0
//
// How the daemon is doing: collected from its parts, and told by log, DDS and HTTP.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "config/config.hpp"
#include "daemon/dds/health_publisher.hpp"
#include "daemon/health/health_log.hpp"
#include "daemon/health/health_monitor.hpp"
#include "daemon/health/worker_report.hpp"
#include "daemon/inputs/inputs.hpp"
#include "daemon/metrics/metrics_server.hpp"

namespace convexcut::daemon {

// One thread, the daemon's main one.
class HealthReporting {
 public:
  using Totals = std::function<HealthCounters()>;

  // `lidar_packets` and `report` are the worker's; all references outlive this. `problems`: of the
  // set-up, that last. Throws DdsError and MetricsError.
  HealthReporting(const Participant& participant, const config::Config& config, Inputs& inputs,
                  const SequencerCounters& lidar_packets, const WorkerReport& report,
                  std::vector<Reason> problems, Totals totals);

  // Every 20 … 100 ms.
  void poll();
  // Once a second: logs what has changed, publishes, serves.
  void report();
  // Everything, to the log.
  void dump() const;

 private:
  [[nodiscard]] HealthSnapshot snapshot() const;

  Inputs& inputs_;
  std::vector<Reason> problems_;
  Totals totals_;
  HealthMonitor monitor_;
  HealthChanges changes_;
  HealthPublisher publisher_;
  std::unique_ptr<MetricsServer> metrics_;  // null: not asked for
};

}  // namespace convexcut::daemon
