// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>

#include "core/counter.hpp"
#include "core/histogram.hpp"
#include "daemon/clock/clock.hpp"
#include "daemon/dds/publisher.hpp"
#include "daemon/dds/scan_status.hpp"
#include "daemon/health/stages.hpp"
#include "daemon/result.hpp"
#include "daemon/write_lead.hpp"

namespace convexcut::daemon {

struct PublishingCounters {
  Counter published;
  Counter late;  // results that were not ready at their instant
  Counter timed_out;
};

// Takes results from the worker and writes each so that the write returns when it is due; a scan
// that comes later is written at once, marked late and counted. Not a realtime thread: DDS
// allocates and locks.
class ScanPublishing {
 public:
  // `stages` outlives this. `complete` fills in the totals of a status: what other parts of the
  // daemon have counted.
  ScanPublishing(const Participant& participant, const config::Dds& settings, const Clock& clock,
                 ResultRing& results, StageHistograms& stages,
                 std::function<void(ScanStatus&)> complete);

  // The thread's body: returns on stop, or when `worker_done` is set and the ring is empty.
  void run(const std::atomic<bool>& stop, const std::atomic<bool>& worker_done);

  [[nodiscard]] bool has_reader() const {
    return publisher_.structure().has_reader() || publisher_.points().has_reader();
  }
  // Any thread.
  [[nodiscard]] const PublishingCounters& counters() const noexcept { return counters_; }
  // How far from its due time each write of structure returned, early or late, while somebody
  // listens; scans that were late already when they came are left out.
  [[nodiscard]] const LatencyHistogram& jitter() const noexcept {
    return stages_.of(Stage::jitter);
  }

 private:
  void publish(const Result& result);

  ScanPublisher publisher_;
  StatusPublisher status_publisher_;
  const Clock& clock_;
  ResultRing& results_;
  std::function<void(ScanStatus&)> complete_;
  PublishingCounters counters_;
  StageHistograms& stages_;
  WriteLead lead_;
  WriteLead empty_lead_;  // of results without points: their writes take next to nothing
};

}  // namespace convexcut::daemon
