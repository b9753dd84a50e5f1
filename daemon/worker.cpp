// SPDX-License-Identifier: Apache-2.0
#include "daemon/worker.hpp"

#include <algorithm>
#include <chrono>

namespace convexcut::daemon {
namespace {

// The worker wakes this long after the expected last firing of a revolution, when its last datagram
// has arrived. The revolution's packets are put in order while its last orientations are still to
// come.
constexpr Duration kCollectTime = std::chrono::milliseconds{1};

// How often the worker looks again when a scan was due but its last packet has not come.
constexpr Duration kLookAgain = std::chrono::microseconds{500};

// Far fewer than a revolution has, even at 20 Hz: they close at most two scans.
constexpr std::size_t kPacketsAtOnce = 16;

// What was received before the host's clock was set has left the sockets and the rings by then.
constexpr Duration kStepGuard = std::chrono::seconds{1};

// When a scan that is handed over at `now` could be known to be whole. What the end of a recording
// cut off could have gone on until then: it is not late for having waited.
HostTime whole_at(const LevelledScan& scan, HostTime now) noexcept {
  return scan.end == ScanEnd::end_of_input ? now : scan.last_firing;
}

}  // namespace

Worker::Worker(const PipelineOptions& pipeline, const WorkerOptions& options, Clock& clock,
               SpscRing<ReturnBatch>& lidar, SpscRing<ImuSample>& imu,
               SpscRing<EncoderSample>& encoder, ResultRing& results)
    : options_(options),
      clock_(clock),
      lidar_(lidar),
      imu_(imu),
      encoder_(encoder),
      results_(results),
      pipeline_(pipeline),
      grid_(options.period) {}

void Worker::run(const std::atomic<bool>& stop, const std::atomic<bool>& lidar_ended,
                 const std::atomic<bool>& imu_ended) noexcept {
  grid_.start(clock_.now());
  HostTime wake = grid_.instant();
  // Relaxed: the flag only ends the loop, it publishes nothing.
  while (!stop.load(std::memory_order_relaxed)) {
    clock_.wait_until(wake);
    follow_clock();
    // Read before draining. Acquire: pairs with the release store of the source thread after its
    // last commit, so that what drain() finds then is all there is.
    const bool no_more_lidar = lidar_ended.load(std::memory_order_acquire);
    const bool no_more_imu = imu_ended.load(std::memory_order_acquire);
    const HostTime now = clock_.now();
    const bool drained = drain(now);
    if (no_more_imu) {
      pipeline_.end_of_imu();
      pipeline_.end_of_encoder();
    }
    if (no_more_lidar && drained) pipeline_.end_of_lidar();
    if (clock_.paced() && !no_more_lidar) {
      end_of_silent_lidar(now);
      wake = serve_instant(now);
      continue;
    }
    const unsigned handed_over = hand_over_all(now);
    if (no_more_lidar && drained && pipeline_.waiting() == 0) return;
    if (handed_over == 0) clock_.pause(kLookAgain);
  }
}

void Worker::follow_clock() noexcept {
  const Duration step = clock_.take_step();
  if (step == Duration::zero()) return;
  counters_.clock_steps.add();
  grid_.shift(step);
  newest_arrival_ += step;
  // Whatever waits may have been stamped before or after.
  const std::size_t packets = lidar_.consume([](ReturnBatch&) noexcept {});
  const std::size_t samples = imu_.consume([](ImuSample&) noexcept {});
  const std::size_t angles = encoder_.consume([](EncoderSample&) noexcept {});
  counters_.dropped_by_clock_step.add(packets + samples + angles);
  pipeline_.restart_time();
  step_guard_until_ = clock_.now() + kStepGuard;
  step_guard_width_ = std::chrono::abs(step) / 2;
}

bool Worker::drain(HostTime now) noexcept {
  // Orientations first: a scan that the lidar's packets close finds its own.
  imu_.consume([this, now](ImuSample& sample) noexcept {
    if (!stamped_before_step(sample.arrival, now)) pipeline_.on_imu(sample);
  });
  encoder_.consume([this, now](EncoderSample& sample) noexcept {
    if (!stamped_before_step(sample.arrival, now)) pipeline_.on_encoder(sample);
  });
  const auto take = [this, now](ReturnBatch& batch) noexcept {
    if (stamped_before_step(batch.arrival, now)) return;
    newest_arrival_ = std::max(newest_arrival_, batch.arrival);
    silent_ = false;
    if (report_ != nullptr) report_->stages.record(Stage::arrival_to_worker, now - batch.arrival);
    pipeline_.on_lidar(batch);
  };
  // A few packets at a time, so that no more scans are closed than can wait.
  while (pipeline_.waiting() + 1 < Pipeline::kMaxWaiting) {
    if (lidar_.consume(take, kPacketsAtOnce) == 0) return true;
  }
  return false;
}

bool Worker::stamped_before_step(HostTime arrival, HostTime now) noexcept {
  if (now >= step_guard_until_) return false;
  if (std::chrono::abs(arrival - now) < step_guard_width_) return false;
  counters_.dropped_by_clock_step.add();
  return true;
}

// What there is of a revolution when the sensor falls silent is a scan.
void Worker::end_of_silent_lidar(HostTime now) noexcept {
  if (silent_ || now < newest_arrival_ + options_.period) return;
  silent_ = true;
  pipeline_.end_of_lidar();
}

HostTime Worker::serve_instant(HostTime now) noexcept {
  if (now < grid_.instant()) return grid_.instant();
  counters_.missed_instants.add(grid_.catch_up(now));
  counters_.superseded_scans.add(pipeline_.drop_superseded(now, grid_.oldest_end()));
  counters_.dropped_scans.add(pipeline_.scans_dropped() - counters_.dropped_scans.value());
  Result* slot = results_.claim();
  if (slot == nullptr) {
    counters_.dropped_results.add();
    grid_.advance();
    return grid_.instant();
  }
  // A scan of a free-running grid is published with its instant, one of a locked grid with itself.
  const bool locked = grid_.locked();
  slot->due = clock_.steady_at(grid_.instant() + options_.latency);
  if (hand_over(now, *slot)) {
    const HostTime last_firing = slot->scan.last_firing;
    if (locked) slot->due = clock_.steady_at(last_firing + options_.latency);
    results_.commit();
    learn();
    grid_.advance_with_scan(last_firing, pipeline_.scan_period());
  } else if (now < give_up()) {
    return now + kLookAgain;
  } else {
    hand_over_empty(*slot);
    results_.commit();
    grid_.advance();
  }
  return grid_.locked() ? grid_.instant() + kCollectTime : grid_.instant();
}

// A locked grid waits for its scan for half a period, less when the sensor has long been silent.
HostTime Worker::give_up() const noexcept {
  if (!grid_.locked()) return grid_.instant();
  const HostTime last_sign = std::min(grid_.instant(), newest_arrival_);
  return std::max(grid_.instant(), last_sign + options_.period / 2);
}

bool Worker::hand_over(HostTime now, Result& slot) noexcept {
  const auto begun = Clock::Steady::now();
  if (!pipeline_.level_next(now, slot.scan)) return false;
  const auto levelled = Clock::Steady::now();
  pipeline_.cut(slot.scan);
  const auto done = Clock::Steady::now();
  const Duration used = done - begun;
  compute_time_.record(used);
  report(levelled - begun, done - levelled);
  slot.effort = effort_.effort();
  if (slot.effort != Effort::full) counters_.reduced_scans.add();
  if (slot.scan.end == ScanEnd::timeout) counters_.unturned_scans.add();
  if (clock_.paced() && options_.reduce_effort) adapt_effort(used, now, slot.scan.last_firing);
  slot.scan.index = next_index_++;
  counters_.scans.add();
  counters_.dropped_no_orientation.add(slot.scan.dropped_no_orientation);
  counters_.scans_without_position.add(pipeline_.scans_without_position() -
                                       counters_.scans_without_position.value());
  return true;
}

void Worker::learn() noexcept {
  const auto begun = Clock::Steady::now();
  if (!pipeline_.learn()) return;
  learning_ = Clock::Steady::now() - begun;
  if (report_ != nullptr) report_->stages.record(Stage::learn, learning_);
}

void Worker::report(Duration levelling, Duration cutting) noexcept {
  if (report_ == nullptr) return;
  report_->stages.record(Stage::level, levelling);
  report_->stages.record(Stage::cut, cutting);
  const auto lidar_source = [&] {
    switch (pipeline_.lidar_time_source()) {
      case LidarTimeSource::none:
        return TimeSource::none;
      case LidarTimeSource::envelope:
        return TimeSource::envelope;
      case LidarTimeSource::pps:
        return TimeSource::pps;
    }
    return TimeSource::none;
  };
  report_->lidar_clock.store(lidar_source(), pipeline_.lidar_clock());
  const bool has_samples = pipeline_.orientations() > 0;
  report_->imu_clock.store(has_samples ? TimeSource::envelope : TimeSource::none,
                           pipeline_.imu_clock());
}

// A scan has the time from when it could be begun until it is due; when its data came late, no less
// than it has after waiting for its last orientation as long as it may (see Daemon): less work
// would not have helped.
void Worker::adapt_effort(Duration used, HostTime begun, HostTime last_firing) noexcept {
  const Duration until_due = last_firing + options_.latency - begun;
  effort_.observe({.used = used,
                   .budget = std::max(until_due, options_.latency / 2),
                   .learning = learning_,
                   .period = options_.period,
                   .learns_first = pipeline_.learns_first()});
  pipeline_.set_effort(effort_.effort());
}

void Worker::hand_over_empty(Result& slot) noexcept {
  slot.scan.clear();
  slot.effort = Effort::full;
  slot.scan.index = next_index_++;
  slot.scan.end = ScanEnd::no_data;
  slot.scan.stamp = grid_.instant() - options_.period;
  slot.scan.last_firing = grid_.instant();
  counters_.empty_results.add();
}

unsigned Worker::hand_over_all(HostTime now) noexcept {
  unsigned count = 0;
  for (;;) {
    Result* slot = results_.claim();
    if (slot == nullptr) return count;  // the scan waits in the pipeline
    if (!hand_over(now, *slot)) return count;
    if (clock_.paced()) slot->due = clock_.steady_at(whole_at(slot->scan, now) + options_.latency);
    counters_.dropped_scans.add(pipeline_.scans_dropped() - counters_.dropped_scans.value());
    results_.commit();
    learn();
    ++count;
  }
}

void reserve_slots(ResultRing& results, std::size_t max_points) {
  for (std::size_t i = 0; i < results.capacity(); ++i) {
    Result* slot = results.claim();
    reserve(slot->scan, max_points);
    results.commit();
  }
  results.consume([](Result&) noexcept {});
}

}  // namespace convexcut::daemon
