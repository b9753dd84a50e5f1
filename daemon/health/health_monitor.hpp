// SPDX-License-Identifier: Apache-2.0
//
// Collects what the parts of the daemon say of themselves into one snapshot.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/health/daemon_health.hpp"
#include "daemon/health/snapshot.hpp"
#include "daemon/health/source_health.hpp"

namespace convexcut::daemon {

// One thread, which is not a realtime one:
//
//   health.add_source("lidar", true, [&] { return reading_of(socket, driver.counters()); });
//   health.add_clock("lidar", worker.lidar_clock());
//   …
//   health.poll(SteadyTime::clock::now(), totals);        // every 20 … 100 ms
//   publish(health.snapshot(now_host, SteadyTime::clock::now()));  // every second
class HealthMonitor {
 public:
  using ReadSource = std::function<SourceReading()>;

  // `stages` outlives the monitor. `pace`, in (0, 1]: how much slower than usual input and results
  // come, because a recording is played slowly; the limits of silence are longer by as much.
  explicit HealthMonitor(const StageHistograms& stages, double pace = 1.0);

  // Before the first poll. `read` is called by poll().
  void add_source(std::string name, bool required, ReadSource read);
  // `gauge` outlives the monitor.
  void add_clock(std::string name, const ClockGauge& gauge);

  // `others`: what is wrong that neither sources nor counters show, e.g. "memory not locked".
  void poll(SteadyTime now, const HealthCounters& totals, const std::vector<Reason>& others = {});

  [[nodiscard]] DaemonState state() const noexcept { return daemon_.state(); }
  // As of the last poll.
  [[nodiscard]] HealthSnapshot snapshot(HostTime stamp, SteadyTime now) const;

 private:
  struct Source {
    SourceMonitor monitor;
    ReadSource read;
  };
  struct Clock {
    std::string name;
    const ClockGauge* gauge;
  };

  const StageHistograms& stages_;
  SourceLimits source_limits_;
  DaemonMonitor daemon_;
  std::vector<Source> sources_;
  std::vector<Clock> clocks_;
  std::vector<SourceHealth> health_;  // of the sources, as of the last poll
  HealthCounters totals_;
  std::optional<SteadyTime> start_;
};

}  // namespace convexcut::daemon
