// SPDX-License-Identifier: Apache-2.0
//
// The worker: drains the rings on a 10 Hz grid and turns what came into labelled scans, one result
// an instant. Design note: docs/design/realtime.md.
#pragma once

#include <atomic>
#include <cstdint>

#include "core/counter.hpp"
#include "core/encoder_sample.hpp"
#include "core/histogram.hpp"
#include "core/imu_sample.hpp"
#include "core/return_batch.hpp"
#include "core/ring/spsc_ring.hpp"
#include "daemon/clock/clock.hpp"
#include "daemon/effort_policy.hpp"
#include "daemon/health/worker_report.hpp"
#include "daemon/pipeline/pipeline.hpp"
#include "daemon/result.hpp"
#include "daemon/result_grid.hpp"

namespace convexcut::daemon {

struct WorkerOptions {
  Duration period = std::chrono::milliseconds{100};
  Duration latency = std::chrono::milliseconds{10};  // from a scan's last firing to its publication
  bool reduce_effort = true;  // when results would be late; never while time is not paced
};

// What the worker saw, for the status topic and the log. Written by the worker only.
struct WorkerCounters {
  Counter scans;                   // handed to the publisher
  Counter empty_results;           // handed over because no scan came
  Counter superseded_scans;        // not handed over: a newer one was there at the same instant
  Counter dropped_scans;           // too many waited
  Counter dropped_results;         // the publisher was not keeping up
  Counter missed_instants;         // the worker was not keeping up
  Counter reduced_scans;           // computed with less than full effort
  Counter unturned_scans;          // given out because no revolution ended in time
  Counter dropped_no_orientation;  // points
  Counter scans_without_position;  // though there are poses
  Counter clock_steps;             // the host's clock was set
  Counter dropped_by_clock_step;   // packets and samples that were stamped before it
};

class Worker {
 public:
  Worker(const PipelineOptions& pipeline, const WorkerOptions& options, Clock& clock,
         SpscRing<ReturnBatch>& lidar, SpscRing<ImuSample>& imu, SpscRing<EncoderSample>& encoder,
         ResultRing& results);

  // Before run(). `report` outlives the worker.
  void report_to(WorkerReport& report) noexcept { report_ = &report; }

  // The thread's body: returns when both inputs have ended and everything is handed on, or on stop.
  // While time is not paced every scan is a result; otherwise there is one result an instant.
  // RT: no allocation, no lock, no text.
  void run(const std::atomic<bool>& stop, const std::atomic<bool>& lidar_ended,
           const std::atomic<bool>& imu_ended) noexcept;

  // Any thread.
  [[nodiscard]] const WorkerCounters& counters() const noexcept { return counters_; }
  // How long levelling and cutting took, each scan.
  [[nodiscard]] const LatencyHistogram& compute_time() const noexcept { return compute_time_; }
  [[nodiscard]] const SequencerCounters& packets() const noexcept {
    return pipeline_.sequencer().counters();
  }

 private:
  void follow_clock() noexcept;
  // Into the pipeline, until the rings are empty (true) or enough scans wait.
  [[nodiscard]] bool drain(HostTime now) noexcept;
  [[nodiscard]] bool stamped_before_step(HostTime arrival, HostTime now) noexcept;
  void end_of_silent_lidar(HostTime now) noexcept;
  // Hands over the result of the grid's instant, if it is time and the scan is there; when to look
  // again.
  [[nodiscard]] HostTime serve_instant(HostTime now) noexcept;
  [[nodiscard]] HostTime give_up() const noexcept;
  // Hands over the oldest scan if it is ready.
  [[nodiscard]] bool hand_over(HostTime now, Result& slot) noexcept;
  // Once a result is on its way.
  void learn() noexcept;
  void adapt_effort(Duration used, HostTime begun, HostTime last_firing) noexcept;
  void hand_over_empty(Result& slot) noexcept;
  void report(Duration levelling, Duration cutting) noexcept;
  // Hands over every scan that is ready; how many.
  unsigned hand_over_all(HostTime now) noexcept;

  WorkerOptions options_;
  Clock& clock_;
  SpscRing<ReturnBatch>& lidar_;
  SpscRing<ImuSample>& imu_;
  SpscRing<EncoderSample>& encoder_;
  ResultRing& results_;
  Pipeline pipeline_;
  ResultGrid grid_;
  EffortPolicy effort_;
  WorkerCounters counters_;
  LatencyHistogram compute_time_;
  WorkerReport* report_ = nullptr;  // none: nobody asked
  std::uint64_t next_index_ = 0;
  Duration learning_{0};  // took the last scan that was learnt from after its labels

  HostTime newest_arrival_{};  // of a lidar packet
  bool silent_ = true;         // the scan at hand was closed because no packet comes
  // After a step of the host's clock: until then, stamps further than this from now are older.
  HostTime step_guard_until_{};
  Duration step_guard_width_{};
};

}  // namespace convexcut::daemon
