// SPDX-License-Identifier: Apache-2.0
#include "daemon/worker.hpp"

#include <algorithm>

namespace convexcut::daemon {
namespace {

// The worker wakes this long after the expected last firing of a revolution, when its last datagram
// has arrived. The revolution's packets are put in order while its last orientations are still to
// come.
constexpr Duration kCollectTime = std::chrono::milliseconds{1};

// The grid follows the rotor only at these speeds (the contract's 9–11 Hz, plus measurement error).
constexpr double kSlowestLocked_hz = 8.9;
constexpr double kFastestLocked_hz = 11.1;

// How often the worker looks again when a scan was due but its last packet has not come.
constexpr Duration kLookAgain = std::chrono::microseconds{500};

// Far fewer than a revolution has, even at 20 Hz: they close at most two scans.
constexpr std::size_t kPacketsAtOnce = 16;

// Without lidar data for this long, results are empty and say so.
constexpr Duration kSilence = std::chrono::milliseconds{300};

}  // namespace

Worker::Worker(const PipelineOptions& pipeline, const WorkerOptions& options, Clock& clock,
               SpscRing<ReturnBatch>& lidar, SpscRing<ImuSample>& imu,
               SpscRing<LevelledScan>& results)
    : options_(options),
      clock_(clock),
      lidar_(lidar),
      imu_(imu),
      results_(results),
      pipeline_(pipeline) {}

void Worker::run(const std::atomic<bool>& stop, const std::atomic<bool>& lidar_ended,
                 const std::atomic<bool>& imu_ended) noexcept {
  HostTime tick = clock_.now() + options_.period;
  last_result_end_ = clock_.now();
  // Relaxed: the flag only ends the loop, it publishes nothing.
  while (!stop.load(std::memory_order_relaxed)) {
    clock_.wait_until(tick);
    // Read before draining. Acquire: pairs with the release store of the source thread after its
    // last commit, so that what drain() finds then is all there is.
    const bool no_more_lidar = lidar_ended.load(std::memory_order_acquire);
    const bool no_more_imu = imu_ended.load(std::memory_order_acquire);
    const HostTime now = clock_.now();
    const bool drained = drain();
    if (no_more_imu) pipeline_.end_of_imu();
    if (no_more_lidar && drained) pipeline_.end_of_lidar();
    const unsigned handed_over = hand_over(now);
    if (no_more_lidar && drained && pipeline_.waiting() == 0) return;
    if (!clock_.paced()) {
      if (handed_over == 0) clock_.pause(kLookAgain);
    } else if (handed_over > 0) {
      tick = drained ? next_tick(tick) : now;
    } else if (now >= last_result_end_ + kSilence) {
      hand_over_empty(now);
      tick = now + options_.period;
    } else {
      tick = now + kLookAgain;
    }
  }
}

bool Worker::drain() noexcept {
  // Orientations first: a scan that the lidar's packets close finds its own.
  imu_.consume([this](ImuSample& sample) noexcept { pipeline_.on_imu(sample); });
  // A few packets at a time, so that no more scans are closed than can wait.
  while (pipeline_.waiting() + 1 < Pipeline::kMaxWaiting) {
    if (lidar_.consume([this](ReturnBatch& batch) noexcept { pipeline_.on_lidar(batch); },
                       kPacketsAtOnce) == 0) {
      return true;
    }
  }
  return false;
}

unsigned Worker::hand_over(HostTime now) noexcept {
  unsigned count = 0;
  for (;;) {
    LevelledScan* slot = results_.claim();
    if (slot == nullptr) return count;  // the ring has counted it; the scan waits in the pipeline
    if (!pipeline_.next_scan(now, *slot)) return count;
    slot->index = next_index_++;
    last_result_end_ = std::max(last_result_end_, slot->last_firing);
    counters_.scans.add();
    counters_.dropped_no_orientation.add(slot->dropped_no_orientation);
    counters_.dropped_scans.add(pipeline_.scans_dropped() - counters_.dropped_scans.value());
    results_.commit();
    ++count;
  }
}

void Worker::hand_over_empty(HostTime now) noexcept {
  LevelledScan* slot = results_.claim();
  if (slot == nullptr) return;
  slot->clear();
  slot->index = next_index_++;
  slot->end = ScanEnd::no_data;
  slot->stamp = now - options_.period;
  slot->last_firing = now;
  counters_.empty_results.add();
  results_.commit();
}

HostTime Worker::next_tick(HostTime tick) const noexcept {
  const double hz = pipeline_.rotor_hz();
  if (hz < kSlowestLocked_hz || hz > kFastestLocked_hz) return tick + options_.period;
  const Duration turn{static_cast<Duration::rep>(1e9 / hz)};
  return last_result_end_ + turn + kCollectTime;
}

void reserve_slots(SpscRing<LevelledScan>& results) {
  for (std::size_t i = 0; i < results.capacity(); ++i) {
    LevelledScan* slot = results.claim();
    reserve(*slot, Pipeline::kMaxReturnsPerScan);
    results.commit();
  }
  results.consume([](LevelledScan&) noexcept {});
}

}  // namespace convexcut::daemon
