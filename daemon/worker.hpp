// SPDX-License-Identifier: Apache-2.0
//
// The worker: drains the rings on a 10 Hz grid and turns what came into labelled scans.
#pragma once

#include <atomic>
#include <cstdint>

#include "core/counter.hpp"
#include "core/imu_sample.hpp"
#include "core/return_batch.hpp"
#include "core/ring/spsc_ring.hpp"
#include "core/scan/scan.hpp"
#include "daemon/clock/clock.hpp"
#include "daemon/pipeline/pipeline.hpp"

namespace convexcut::daemon {

struct WorkerOptions {
  Duration period = std::chrono::milliseconds{100};
  Duration latency = std::chrono::milliseconds{10};  // from a scan's last firing to its publication
};

// What the worker saw, for the status topic and the log. Written by the worker only.
struct WorkerCounters {
  Counter scans;                   // handed to the publisher
  Counter empty_results;           // handed over because no lidar data came
  Counter dropped_scans;           // the publisher was not keeping up
  Counter dropped_no_orientation;  // points
};

class Worker {
 public:
  Worker(const PipelineOptions& pipeline, const WorkerOptions& options, Clock& clock,
         SpscRing<ReturnBatch>& lidar, SpscRing<ImuSample>& imu, SpscRing<LevelledScan>& results);

  // The thread's body: returns when both inputs have ended and everything is handed on, or on stop.
  // RT after the first result: no allocation, no lock, no text.
  void run(const std::atomic<bool>& stop, const std::atomic<bool>& lidar_ended,
           const std::atomic<bool>& imu_ended) noexcept;

  // Any thread.
  [[nodiscard]] const WorkerCounters& counters() const noexcept { return counters_; }
  [[nodiscard]] const SequencerCounters& packets() const noexcept {
    return pipeline_.sequencer().counters();
  }

 private:
  // Into the pipeline, until the rings are empty (true) or enough scans wait.
  [[nodiscard]] bool drain() noexcept;
  // Hands over every scan that is ready; how many.
  unsigned hand_over(HostTime now) noexcept;
  void hand_over_empty(HostTime now) noexcept;
  [[nodiscard]] HostTime next_tick(HostTime tick) const noexcept;

  WorkerOptions options_;
  Clock& clock_;
  SpscRing<ReturnBatch>& lidar_;
  SpscRing<ImuSample>& imu_;
  SpscRing<LevelledScan>& results_;
  Pipeline pipeline_;
  WorkerCounters counters_;
  HostTime last_result_end_{};  // last firing of the newest handed-over scan
  std::uint64_t next_index_ = 0;
};

// Gives every slot of the ring its memory, so that the worker never allocates. Before the threads
// start.
void reserve_slots(SpscRing<LevelledScan>& results);

}  // namespace convexcut::daemon
