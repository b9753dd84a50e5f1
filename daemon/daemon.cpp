// SPDX-License-Identifier: Apache-2.0
#include "daemon/daemon.hpp"

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <string>
#include <utility>

#include "daemon/inputs/live_inputs.hpp"
#include "daemon/inputs/recorded_inputs.hpp"
#include "daemon/log/log.hpp"

namespace convexcut::daemon {
namespace {

WorkerOptions worker_options(const config::Worker& settings) {
  return {std::chrono::milliseconds{settings.period_ms},
          std::chrono::milliseconds{settings.latency_ms}, settings.reduce_effort};
}

[[nodiscard]] bool takes_dual_returns(const PipelineOptions& options) {
  return options.cut.echoes == CutOptions::Echoes::both;
}

// In the daemon a scan waits for its last orientations no longer than the latency allows: three
// fifths of it remain for levelling, cutting and writing.
PipelineOptions live_pipeline_options(const DaemonOptions& daemon) {
  PipelineOptions options = pipeline_options(daemon.config);
  options.positions = recorded_positions(daemon.recordings);
  options.orientation_wait =
      std::min(options.orientation_wait,
               Duration{std::chrono::milliseconds{daemon.config.worker.latency_ms}} * 2 / 5);
  // Memory is locked: what only dual returns need is not taken without them.
  if (!takes_dual_returns(options) && options.cut.mode == CutOptions::Mode::revolution) {
    options.max_returns_per_scan = kMostSingleReturnsPerScan;
  }
  return options;
}

std::unique_ptr<Inputs> make_inputs(const DaemonOptions& options, InputRings& rings,
                                    const std::atomic<bool>& stop) {
  if (options.recordings.lidar.empty()) {
    return std::make_unique<LiveInputs>(options.config, rings, stop);
  }
  return std::make_unique<RecordedInputs>(options.recordings, options.config, options.rate, rings,
                                          stop);
}

// A worker that is never paced would take a CPU for itself.
config::RealtimeSettings realtime_settings(const DaemonOptions& options) {
  config::RealtimeSettings settings = options.config.realtime;
  if (!options.recordings.lidar.empty() && options.rate == 0.0) {
    settings.enabled = config::Realtime::off;
  }
  return settings;
}

// What stays wrong for as long as the daemon runs.
std::vector<Reason> lasting_problems(const Realtime& realtime) {
  if (realtime.problems().empty()) return {};
  return {{Severity::degraded, "realtime set-up incomplete"}};
}

// What labels that wait for what their scan shows take in a large hall on one core of a desktop,
// the last orientations included (docs/design/robust.md).
constexpr std::int64_t kLearnFirstLatencyMs = 40;

void warn_of_latency(const DaemonOptions& options) {
  const config::Config& config = options.config;
  if (config.convex_cut.method != config::Method::robust || !config.convex_cut.learn_first) return;
  if (config.worker.latency_ms >= kLearnFirstLatencyMs) return;
  const std::string needed_ms = std::to_string(kLearnFirstLatencyMs);
  log::warning("latency", {{"problem", "convex_cut.method = \"robust\" takes up to " + needed_ms +
                                           " ms a scan, worker.latency_ms is " +
                                           std::to_string(config.worker.latency_ms) +
                                           ": less will be computed, or results be late; set "
                                           "worker.latency_ms=" +
                                           needed_ms + ", or convex_cut.learn_first=false"}});
}

constexpr auto kSupervision = std::chrono::milliseconds{20};
constexpr auto kReportEvery = std::chrono::seconds{1};

}  // namespace

Daemon::Daemon(const DaemonOptions& options)
    : options_(options),
      pipeline_options_(live_pipeline_options(options)),
      realtime_(realtime_settings(options)),
      rings_(takes_dual_returns(pipeline_options_)),
      inputs_(make_inputs(options, rings_, stop_)),
      worker_(realtime_.as(ThreadRole::worker,
                           [&] {
                             return Worker(pipeline_options_, worker_options(options.config.worker),
                                           inputs_->clock(), rings_.lidar, rings_.imu,
                                           rings_.encoder, results_);
                           })),
      participant_(
          realtime_.as(ThreadRole::transport, [&] { return Participant(options.config.dds); })),
      scans_(participant_, options.config.dds, inputs_->clock(), results_, stages_,
             [this](ScanStatus& status) { complete(status); }),
      imus_(participant_, options.config.dds, rings_.imu_publish, rings_.imu_publish_filled),
      health_(participant_, options.config, *inputs_, worker_.packets(), worker_report_,
              lasting_problems(realtime_), [this] { return health_counters(); }) {
  worker_.report_to(worker_report_);
  if (options.recordings.lidar.empty()) rings_.returns.measure_into(stages_);
  reserve_slots(results_, pipeline_options_.max_returns_per_scan);
}

Daemon::~Daemon() {
  stop_.store(true, std::memory_order_relaxed);
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

void Daemon::run() {
  inputs_->log_start();
  for (const std::string& problem : realtime_.problems()) {
    log::warning("realtime", {{"problem", problem}});
  }
  warn_of_latency(options_);
  log::info("start", {{"domain", options_.config.dds.domain},
                      {"scheduling", realtime_.scheduled() ? "fifo" : "normal"},
                      {"memory", realtime_.memory_locked() ? "locked" : "normal"}});
  wait_for_reader();
  if (!signalled()) {
    start_threads();
    supervise();
  }
  log_threads();
  log_timing();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  log_losses();
  log_end();
  if (!signalled()) inputs_->check_content();
}

void Daemon::wait_for_reader() {
  const auto until = std::chrono::steady_clock::now() + options_.wait_for_reader;
  while (!scans_.has_reader() && std::chrono::steady_clock::now() < until) {
    if (!pause(kSupervision)) return;
  }
}

void Daemon::start_threads() {
  realtime_.populate_memory();
  started_ = std::chrono::steady_clock::now();
  for (InputThread& thread : inputs_->start()) {
    start_thread(thread.name, thread.role, std::move(thread.body));
  }
  start_thread("worker", ThreadRole::worker, [this] {
    worker_.run(stop_, inputs_->lidar_ended(), inputs_->imu_ended());
    worker_done_.store(true, std::memory_order_release);  // pairs with ScanPublishing::run
  });
  start_thread("publish", ThreadRole::publish, [this] {
    scans_.run(stop_, worker_done_);
    published_.store(true, std::memory_order_release);  // pairs with supervise()
  });
  start_thread("publish_imu", ThreadRole::publish,
               [this] { imus_.run(stop_, inputs_->imu_ended()); });
}

void Daemon::start_thread(const char* name, ThreadRole role, std::function<void()> body) {
  threads_.emplace_back([this, name, role, body = std::move(body)] {
    realtime_.enter(role, name);
    register_.enter(name, role);
    body();
    ThreadRegister::leave();
  });
}

void Daemon::supervise() {
  auto next_report = std::chrono::steady_clock::now() + kReportEvery;
  bool steady = false;
  // Acquire: pairs with the release store when the last result has been written.
  while (!published_.load(std::memory_order_acquire)) {
    if (!pause(kSupervision)) return;
    health_.poll();
    if (std::chrono::steady_clock::now() >= next_report) {
      next_report += kReportEvery;
      if (!std::exchange(steady, true)) register_.mark_steady();
      inputs_->log_changes();
      log_losses();
      health_.report();
    }
  }
}

bool Daemon::pause(Duration span) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGUSR1);
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(span);
  const std::timespec timeout{whole.count(), (span - whole).count()};
  const int signal = ::sigtimedwait(&signals, nullptr, &timeout);
  if (signal == SIGUSR1) health_.dump();
  if (signal < 0 || signal == SIGUSR1) return true;
  log::info("stop", {{"signal", signal == SIGINT ? "SIGINT" : "SIGTERM"}});
  stop_.store(true, std::memory_order_relaxed);
  return false;
}

void Daemon::complete(ScanStatus& status) const {
  const InputTotals totals = inputs_->totals();
  status.lost_packets_total = worker_.packets().lost.value();
  status.rejected_packets_total = totals.rejected_lidar_packets;
  status.lost_imu_samples_total = totals.lost_imu_samples;
  status.ring_overruns_total = rings_.overruns();
  status.reduced_scans_total = worker_.counters().reduced_scans.value();
}

HealthCounters Daemon::health_counters() const {
  const WorkerCounters& worker = worker_.counters();
  const RecordedTotals recorded = inputs_->recorded();
  HealthCounters totals;
  totals.results = scans_.counters().published.value();
  totals.empty_results = worker.empty_results.value();
  totals.late_results = scans_.counters().late.value();
  totals.dropped_scans = worker.dropped_scans.value() + worker.dropped_results.value();
  totals.reduced_scans = worker.reduced_scans.value();
  totals.unturned_scans = worker.unturned_scans.value();
  totals.points_without_orientation = worker.dropped_no_orientation.value();
  totals.late_packets = worker_.packets().late.value();
  totals.ring_overruns = rings_.overruns();
  totals.publish_timeouts = scans_.counters().timed_out.value();
  totals.recorded_records = recorded.records;
  totals.recorded_bytes = recorded.bytes;
  totals.unrecorded_records = recorded.missing;
  return totals;
}

void Daemon::log_losses() {
  ScanStatus totals;
  complete(totals);
  const WorkerCounters& worker = worker_.counters();
  const std::uint64_t losses =
      totals.lost_packets_total + totals.rejected_packets_total + totals.lost_imu_samples_total +
      totals.ring_overruns_total + scans_.counters().late.value() +
      scans_.counters().timed_out.value() + worker.dropped_scans.value() +
      worker.superseded_scans.value() + worker.dropped_results.value() +
      worker.missed_instants.value() + worker.reduced_scans.value() + worker.clock_steps.value() +
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
                          {"superseded_scans", worker.superseded_scans.value()},
                          {"dropped_results", worker.dropped_results.value()},
                          {"missed_instants", worker.missed_instants.value()},
                          {"reduced_scans", worker.reduced_scans.value()},
                          {"clock_steps", worker.clock_steps.value()},
                          {"publish_timeouts", scans_.counters().timed_out.value()}});
}

void Daemon::log_threads() {
  for (const ThreadFigures& thread : register_.figures()) {
    log::info("thread", {{"name", thread.name},
                         {"allocations", thread.allocations},
                         {"minor_faults", thread.minor_faults},
                         {"major_faults", thread.major_faults},
                         {"cpu_ms", thread.cpu_time / std::chrono::milliseconds{1}}});
  }
}

void Daemon::log_timing() const {
  const LatencyHistogram& jitter = scans_.jitter();
  const LatencyHistogram& compute = worker_.compute_time();
  const auto us = [](Duration span) { return span / std::chrono::microseconds{1}; };
  const Duration run = std::chrono::steady_clock::now() - started_;
  log::info("timing", {{"run_ms", run / std::chrono::milliseconds{1}},
                       {"results", scans_.counters().published.value()},
                       {"late", scans_.counters().late.value()},
                       {"jitter_p50_us", us(jitter.percentile(50.0))},
                       {"jitter_p99_us", us(jitter.percentile(99.0))},
                       {"jitter_p999_us", us(jitter.percentile(99.9))},
                       {"jitter_max_us", us(jitter.max())},
                       {"compute_p50_us", us(compute.percentile(50.0))},
                       {"compute_p99_us", us(compute.percentile(99.0))},
                       {"compute_max_us", us(compute.max())},
                       {"reduced_scans", worker_.counters().reduced_scans.value()}});
}

void Daemon::log_end() const {
  inputs_->log_end();
  const InputTotals totals = inputs_->totals();
  log::info("end", {{"model", totals.model},
                    {"packets", totals.lidar_packets},
                    {"position_packets", totals.position_packets},
                    {"rejected_packets", totals.rejected_lidar_packets},
                    {"lost_packets", worker_.packets().lost.value()},
                    {"duplicate_packets", worker_.packets().duplicates.value()},
                    {"reordered_packets", worker_.packets().reordered.value()},
                    {"late_packets", worker_.packets().late.value()},
                    {"kernel_drops", totals.kernel_drops},
                    {"ring_overruns", rings_.overruns()},
                    {"imu_samples", totals.imu_samples},
                    {"lost_imu_samples", totals.lost_imu_samples},
                    {"scans", scans_.counters().published.value()},
                    {"without_position", worker_.counters().scans_without_position.value()},
                    {"empty", worker_.counters().empty_results.value()},
                    {"late", scans_.counters().late.value()}});
}

}  // namespace convexcut::daemon
