// SPDX-License-Identifier: Apache-2.0
#include "daemon/scan_publishing.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace convexcut::daemon {
namespace {

// The stop flag is looked at this often.
constexpr Duration kLongestWait = std::chrono::milliseconds{50};

}  // namespace

ScanPublishing::ScanPublishing(const Participant& participant, const config::Dds& settings,
                               const Clock& clock, ResultRing& results, StageHistograms& stages,
                               std::function<void(ScanStatus&)> complete)
    : publisher_(participant, settings),
      status_publisher_(participant, settings),
      clock_(clock),
      results_(results),
      complete_(std::move(complete)),
      stages_(stages) {}

void ScanPublishing::run(const std::atomic<bool>& stop, const std::atomic<bool>& worker_done) {
  // Relaxed: the flag only ends the loop, it publishes nothing.
  while (!stop.load(std::memory_order_relaxed)) {
    // Before looking into the ring. Acquire: pairs with the release store after the worker's last
    // commit, so that an empty ring then stays empty.
    const bool done = worker_done.load(std::memory_order_acquire);
    const Result* result = results_.front();
    if (result != nullptr) {
      publish(*result);
      results_.pop();
    } else if (done) {
      return;
    } else {
      results_.wait(kLongestWait);
    }
  }
}

void ScanPublishing::publish(const Result& result) {
  const LevelledScan& scan = result.scan;
  const bool late =
      clock_.paced() && scan.end != ScanEnd::no_data && Clock::Steady::now() > result.due;
  publisher_.prepare_structure(scan);
  WriteLead& lead = scan.size() == 0 ? empty_lead_ : lead_;
  clock_.wait_until(result.due - lead.value());
  const auto begun = Clock::Steady::now();
  const PublishStatus structure = publisher_.publish_prepared_structure();
  const auto written = Clock::Steady::now();
  lead.observe(written - begun);
  if (clock_.paced() && !late && structure == PublishStatus::sent) {
    stages_.record(Stage::jitter, std::chrono::abs(written - result.due));
  }
  const Duration latency =
      (clock_.paced() ? clock_.host_at(written) : clock_.now()) - scan.last_firing;
  stages_.record(Stage::publish, written - begun);
  if (scan.end != ScanEnd::no_data) stages_.record(Stage::latency, latency);
  const PublishStatus points = publisher_.publish_points(scan);

  counters_.published.add();
  if (late) counters_.late.add();
  for (const PublishStatus status : {structure, points}) {
    if (status == PublishStatus::timed_out) counters_.timed_out.add();
  }

  ScanStatus status;
  status.stamp = scan.stamp;
  status.index = scan.index;
  status.end = scan.end;
  status.late = late;
  status.points = static_cast<std::uint32_t>(scan.size());
  status.structure_points = scan.structure_points;
  status.dropped_no_orientation = scan.dropped_no_orientation;
  status.overflow_returns = scan.overflow_returns;
  status.coverage = scan.coverage;
  status.latency = latency;
  status.late_scans_total = counters_.late.value();
  status.publish_timeouts_total = counters_.timed_out.value();
  status.effort = static_cast<std::uint8_t>(result.effort);
  complete_(status);
  status_publisher_.publish(status);
}

}  // namespace convexcut::daemon
