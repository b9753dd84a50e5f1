// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>

#include "core/counter.hpp"
#include "core/ring/spsc_ring.hpp"
#include "core/scan/scan.hpp"
#include "daemon/clock/clock.hpp"
#include "daemon/dds/publisher.hpp"
#include "daemon/dds/scan_status.hpp"

namespace convexcut::daemon {

struct PublishingCounters {
  Counter published;
  Counter late;  // results that were not ready at their instant
  Counter timed_out;
};

// Takes results from the worker and writes each so that the write returns `latency` after the
// scan's last firing; one that comes later is written at once, marked late and counted. Not a
// realtime thread: DDS allocates and locks.
class ScanPublishing {
 public:
  // `complete` fills in the totals of a status: what other parts of the daemon have counted.
  ScanPublishing(const Participant& participant, const config::Dds& settings, Duration latency,
                 const Clock& clock, SpscRing<LevelledScan>& results,
                 std::function<void(ScanStatus&)> complete);

  // The thread's body: returns on stop, or when `worker_done` is set and the ring is empty.
  void run(const std::atomic<bool>& stop, const std::atomic<bool>& worker_done);

  [[nodiscard]] bool has_reader() const {
    return publisher_.structure().has_reader() || publisher_.points().has_reader();
  }
  [[nodiscard]] const PublishingCounters& counters() const noexcept { return counters_; }

 private:
  void publish(const LevelledScan& scan);

  ScanPublisher publisher_;
  StatusPublisher status_publisher_;
  Duration latency_;
  const Clock& clock_;
  SpscRing<LevelledScan>& results_;
  std::function<void(ScanStatus&)> complete_;
  PublishingCounters counters_;
  Duration lead_{0};  // average time of a write
};

}  // namespace convexcut::daemon
