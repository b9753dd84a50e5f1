// SPDX-License-Identifier: Apache-2.0
#include "daemon/daemon.hpp"

#include <algorithm>
#include <csignal>
#include <ctime>
#include <utility>

#include "daemon/log/log.hpp"
#include "drivers/velodyne/model.hpp"

namespace convexcut::daemon {
namespace {

WorkerOptions worker_options(const config::Worker& settings) {
  return {std::chrono::milliseconds{settings.period_ms},
          std::chrono::milliseconds{settings.latency_ms}};
}

// In the daemon a scan waits for its last orientations no longer than the latency allows: three
// fifths of it remain for levelling, cutting and writing.
PipelineOptions live_pipeline_options(const config::Config& config) {
  PipelineOptions options = pipeline_options(config);
  options.orientation_wait =
      std::min(options.orientation_wait,
               Duration{std::chrono::milliseconds{config.worker.latency_ms}} * 2 / 5);
  return options;
}

constexpr auto kSupervision = std::chrono::milliseconds{20};
constexpr auto kReportEvery = std::chrono::seconds{1};

}  // namespace

Daemon::Daemon(const DaemonOptions& options)
    : options_(options),
      clock_(options.rate, stop_),
      recordings_(options.recordings, options.config, lidar_sink_, imu_sink_),
      worker_(live_pipeline_options(options.config), worker_options(options.config.worker), clock_,
              lidar_ring_, imu_ring_, results_),
      participant_(options.config.dds),
      scans_(participant_, options.config.dds,
             std::chrono::milliseconds{options.config.worker.latency_ms}, clock_, results_,
             [this](ScanStatus& status) { complete(status); }),
      imus_(participant_, options.config.dds, imu_publish_ring_) {
  reserve_slots(results_);
}

Daemon::~Daemon() {
  stop_.store(true, std::memory_order_relaxed);
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

void Daemon::run() {
  log::info("start", {{"lidar", options_.recordings.lidar.string()},
                      {"imu", options_.recordings.imu.string()},
                      {"can", options_.recordings.can.string()},
                      {"rate", clock_.paced() ? std::to_string(options_.rate) : "max"},
                      {"domain", options_.config.dds.domain}});
  wait_for_reader();
  if (!signalled()) {
    start_threads();
    supervise();
  }
  stop_.store(signalled(), std::memory_order_relaxed);
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  log_losses();
  log_end();
  if (!signalled()) recordings_.check_content();
}

void Daemon::wait_for_reader() {
  const auto until = std::chrono::steady_clock::now() + options_.wait_for_reader;
  while (!scans_.has_reader() && std::chrono::steady_clock::now() < until) {
    if (!pause(kSupervision)) return;
  }
}

void Daemon::start_threads() {
  clock_.start(recordings_.first_stamp());
  if (clock_.paced()) {
    const auto streams = recordings_.streams();
    start_source(*streams.front(), lidar_ended_);
    const bool imu = recordings_.imu() != nullptr;
    if (imu) start_source(*streams[1], imu_ended_);
    if (recordings_.can() != nullptr && !imu) start_source(*streams[1], imu_ended_);
    if (streams.size() == 1) imu_ended_.store(true, std::memory_order_release);
  } else {
    start_merged_sources();
  }
  threads_.emplace_back([this] {
    worker_.run(stop_, lidar_ended_, imu_ended_);
    worker_done_.store(true, std::memory_order_release);  // pairs with ScanPublishing::run
  });
  threads_.emplace_back([this] {
    scans_.run(stop_, worker_done_);
    published_.store(true, std::memory_order_release);  // pairs with supervise()
  });
  threads_.emplace_back([this] { imus_.run(stop_, imu_ended_); });
}

void Daemon::start_source(recording::RecordedStream& stream, std::atomic<bool>& ended) {
  threads_.emplace_back([this, &stream, &ended] {
    while (const auto stamp = stream.next_stamp()) {
      clock_.wait_until(*stamp);
      if (signalled()) break;
      stream.deliver();
    }
    stream.finish();
    ended.store(true, std::memory_order_release);  // pairs with Worker::run and ImuPublishing::run
  });
}

void Daemon::start_merged_sources() {
  threads_.emplace_back([this] {
    // As fast as possible means: as fast as the rings are emptied. Nothing is lost.
    const auto full = [](const auto& ring) { return ring.size_approx() + 8 > ring.capacity(); };
    while (!signalled()) {
      if (full(lidar_ring_) || full(imu_ring_) || full(imu_publish_ring_)) {
        std::this_thread::sleep_for(std::chrono::microseconds{100});
        continue;
      }
      const auto stamp = recordings_.step();
      if (!stamp) break;
      clock_.delivered(*stamp);
    }
    recordings_.finish();
    lidar_ended_.store(true, std::memory_order_release);  // pairs with Worker::run
    imu_ended_.store(true, std::memory_order_release);    // and ImuPublishing::run
  });
}

void Daemon::supervise() {
  auto next_report = std::chrono::steady_clock::now() + kReportEvery;
  // Acquire: pairs with the release store when the last result has been written.
  while (!published_.load(std::memory_order_acquire)) {
    if (!pause(kSupervision)) return;
    if (std::chrono::steady_clock::now() >= next_report) {
      next_report += kReportEvery;
      log_losses();
    }
  }
}

bool Daemon::pause(Duration span) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(span);
  const std::timespec timeout{whole.count(), (span - whole).count()};
  const int signal = ::sigtimedwait(&signals, nullptr, &timeout);
  if (signal < 0) return true;
  log::info("stop", {{"signal", signal == SIGINT ? "SIGINT" : "SIGTERM"}});
  stop_.store(true, std::memory_order_relaxed);
  return false;
}

void Daemon::complete(ScanStatus& status) const {
  const velodyne::LidarCounters& lidar = recordings_.lidar_driver().counters();
  status.lost_packets_total = worker_.packets().lost.value();
  status.rejected_packets_total =
      lidar.foreign.value() + lidar.wrong_length.value() + lidar.wrong_block_flag.value() +
      lidar.azimuth_out_of_range.value() + lidar.timestamp_out_of_range.value() +
      lidar.no_sentence.value() + lidar.model_unknown.value();
  status.lost_imu_samples_total = lost_imu_samples();
  status.ring_overruns_total = lidar_ring_.overruns() + imu_ring_.overruns();
}

std::uint64_t Daemon::lost_imu_samples() const {
  if (recordings_.imu() != nullptr) return recordings_.imu()->counters().lost_messages.value();
  if (recordings_.can() != nullptr) return recordings_.can()->counters().lost_groups.value();
  return 0;
}

void Daemon::log_losses() {
  ScanStatus totals;
  complete(totals);
  const WorkerCounters& worker = worker_.counters();
  const std::uint64_t losses =
      totals.lost_packets_total + totals.rejected_packets_total + totals.lost_imu_samples_total +
      totals.ring_overruns_total + scans_.counters().late.value() +
      scans_.counters().timed_out.value() + worker.dropped_scans.value() +
      worker_.packets().late.value() + worker.dropped_no_orientation.value();
  if (losses == reported_losses_) return;
  reported_losses_ = losses;
  log::warning("losses", {{"lost_packets", totals.lost_packets_total},
                          {"late_packets", worker_.packets().late.value()},
                          {"rejected_packets", totals.rejected_packets_total},
                          {"lost_imu_samples", totals.lost_imu_samples_total},
                          {"ring_overruns", totals.ring_overruns_total},
                          {"points_without_orientation", worker.dropped_no_orientation.value()},
                          {"late_scans", scans_.counters().late.value()},
                          {"dropped_scans", worker.dropped_scans.value()},
                          {"publish_timeouts", scans_.counters().timed_out.value()}});
}

void Daemon::log_end() const {
  for (const std::string& warning : recordings_.warnings()) {
    log::warning("recording", {{"problem", warning}});
  }
  const auto model = recordings_.lidar_driver().model();
  log::info("end", {{"model", model ? velodyne::model_of(*model).name : "unknown"},
                    {"packets", recordings_.lidar_driver().counters().data_packets.value()},
                    {"scans", scans_.counters().published.value()},
                    {"empty", worker_.counters().empty_results.value()},
                    {"late", scans_.counters().late.value()}});
}

}  // namespace convexcut::daemon
