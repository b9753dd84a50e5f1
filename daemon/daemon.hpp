// SPDX-License-Identifier: Apache-2.0
//
// The daemon as a whole: sources → rings → worker → publishers, one thread each.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "config/config.hpp"
#include "core/imu_sample.hpp"
#include "core/return_batch.hpp"
#include "core/ring/ring_sink.hpp"
#include "core/ring/spsc_ring.hpp"
#include "core/scan/scan.hpp"
#include "daemon/dds/participant.hpp"
#include "daemon/imu_publishing.hpp"
#include "daemon/playback_clock.hpp"
#include "daemon/scan_publishing.hpp"
#include "daemon/sources/recordings.hpp"
#include "daemon/worker.hpp"

namespace convexcut::daemon {

struct DaemonOptions {
  config::Config config;
  RecordingPaths recordings;
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

  // Runs until the recordings have ended or SIGINT or SIGTERM comes, which must be blocked in every
  // thread. Throws std::runtime_error when the recordings hold nothing of use.
  void run();

 private:
  // 0.5 s of a dual-return HDL-32E (3617 packets/s): several periods of the worker.
  static constexpr std::size_t kLidarSlots = 2048;
  // 2.5 s at 400 Hz.
  static constexpr std::size_t kImuSlots = 1024;
  static constexpr std::size_t kResultSlots = 4;

  void wait_for_reader();
  void start_threads();
  void start_source(recording::RecordedStream& stream, std::atomic<bool>& ended);
  void start_merged_sources();
  // Returns when the work is done or a signal has come; logs what went wrong meanwhile.
  void supervise();
  // False when a signal came within `span`.
  bool pause(Duration span);
  void log_losses();
  void log_end() const;
  void complete(ScanStatus& status) const;
  [[nodiscard]] std::uint64_t lost_imu_samples() const;
  [[nodiscard]] bool signalled() const noexcept { return stop_.load(std::memory_order_relaxed); }

  DaemonOptions options_;
  std::atomic<bool> stop_{false};
  // Release stores after a source's last commit; acquire loads in the consumers (worker,
  // publishers).
  std::atomic<bool> lidar_ended_{false};
  std::atomic<bool> imu_ended_{false};
  std::atomic<bool> worker_done_{false};
  std::atomic<bool> published_{false};

  SpscRing<ReturnBatch> lidar_ring_{kLidarSlots};
  SpscRing<ImuSample> imu_ring_{kImuSlots};
  SpscRing<ImuSample> imu_publish_ring_{kImuSlots};
  SpscRing<LevelledScan> results_{kResultSlots};
  RingSink<ReturnBatch> lidar_sink_{lidar_ring_};
  ImuTee imu_sink_{imu_ring_, imu_publish_ring_};

  PlaybackClock clock_;
  Recordings recordings_;
  Worker worker_;
  Participant participant_;
  ScanPublishing scans_;
  ImuPublishing imus_;
  std::vector<std::thread> threads_;
  std::uint64_t reported_losses_ = 0;
};

}  // namespace convexcut::daemon
