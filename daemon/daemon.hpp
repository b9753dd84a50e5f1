// SPDX-License-Identifier: Apache-2.0
//
// The daemon as a whole: inputs → rings → worker → publishers, one thread each.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "config/config.hpp"
#include "daemon/dds/participant.hpp"
#include "daemon/health_reporting.hpp"
#include "daemon/imu_publishing.hpp"
#include "daemon/inputs/input_rings.hpp"
#include "daemon/inputs/inputs.hpp"
#include "daemon/realtime/realtime.hpp"
#include "daemon/realtime/thread_figures.hpp"
#include "daemon/result.hpp"
#include "daemon/scan_publishing.hpp"
#include "daemon/sources/recordings.hpp"
#include "daemon/worker.hpp"

namespace convexcut::daemon {

struct DaemonOptions {
  config::Config config;
  RecordingPaths recordings;    // without a lidar's: live
  double rate = 1.0;            // recorded seconds per second; 0: as fast as possible
  Duration wait_for_reader{0};  // how long the start waits for a subscriber
};

class Daemon {
 public:
  // Opens everything. Throws what the parts throw: one line each.
  explicit Daemon(const DaemonOptions& options);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  ~Daemon();

  // Runs until the recordings have ended or SIGINT or SIGTERM comes; SIGUSR1 writes all that is
  // known of the daemon's health to the log. The three must be blocked in every thread. Throws
  // std::runtime_error when the recordings hold nothing of use.
  void run();

 private:
  static constexpr std::size_t kResultSlots = 4;

  void wait_for_reader();
  void start_threads();
  void start_thread(const char* name, ThreadRole role, std::function<void()> body);
  // Returns when the work is done or a signal has come; logs what went wrong meanwhile.
  void supervise();
  // False when a signal to stop came within `span`.
  bool pause(Duration span);
  void log_losses();
  void log_threads();
  void log_timing() const;
  void log_end() const;
  void complete(ScanStatus& status) const;
  [[nodiscard]] HealthCounters health_counters() const;
  [[nodiscard]] bool signalled() const noexcept { return stop_.load(std::memory_order_relaxed); }

  const DaemonOptions options_;
  const PipelineOptions pipeline_options_;
  Realtime realtime_;  // before anything that starts threads
  ThreadRegister register_;
  InputRings rings_;
  ResultRing results_{kResultSlots};
  std::atomic<bool> stop_{false};
  // Release stores when a thread is done; acquire loads in what waits for it.
  std::atomic<bool> worker_done_{false};
  std::atomic<bool> published_{false};

  StageHistograms stages_;
  WorkerReport worker_report_{stages_, {}, {}};
  std::unique_ptr<Inputs> inputs_;
  Worker worker_;
  Participant participant_;
  ScanPublishing scans_;
  ImuPublishing imus_;
  HealthReporting health_;
  std::vector<std::thread> threads_;
  std::chrono::steady_clock::time_point started_{};
  std::uint64_t reported_losses_ = 0;
};

}  // namespace convexcut::daemon
