// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "core/scan/packet_sequencer.hpp"
#include "daemon/clock/clock.hpp"
#include "daemon/health/health_monitor.hpp"
#include "daemon/realtime/thread_role.hpp"

namespace convexcut::daemon {

// A thread that an input needs. The body returns at the end of the input, or soon after a stop.
struct InputThread {
  const char* name = "";  // up to 15 characters, outlives the thread
  ThreadRole role = ThreadRole::other;
  std::function<void()> body;
};

// What has come in since the start.
struct InputTotals {
  std::string_view model = "unknown";  // of the lidar
  std::uint64_t position_packets = 0;
  std::uint64_t lidar_packets = 0;           // decoded
  std::uint64_t rejected_lidar_packets = 0;  // received, and not a lidar's
  std::uint64_t kernel_drops = 0;            // datagrams that the kernel had no room for
  std::uint64_t imu_samples = 0;             // decoded
  std::uint64_t lost_imu_samples = 0;        // by the IMU's own count
};

// What a live run has written to its recording.
struct RecordedTotals {
  std::uint64_t records = 0;
  std::uint64_t bytes = 0;
  std::uint64_t missing = 0;  // records
};

// Where the daemon's data come from, recordings or live sensors, and the clock that they are in.
// Everything behind it is the same for both.
class Inputs {
 public:
  Inputs() = default;
  Inputs(const Inputs&) = delete;
  Inputs& operator=(const Inputs&) = delete;
  virtual ~Inputs() = default;

  // Starts the clock. Once, before the threads are started.
  [[nodiscard]] virtual std::vector<InputThread> start() = 0;
  [[nodiscard]] virtual Clock& clock() noexcept = 0;

  // Set when nothing more will come, after the last commit to a ring: never while live. Angles of a
  // stage end with the IMU's samples.
  [[nodiscard]] const std::atomic<bool>& lidar_ended() const noexcept { return lidar_ended_; }
  [[nodiscard]] const std::atomic<bool>& imu_ended() const noexcept { return imu_ended_; }

  // Any thread.
  [[nodiscard]] virtual InputTotals totals() const noexcept = 0;

  // How much slower than the sensors' time the input comes: 1 when live, up to 1 from a recording.
  [[nodiscard]] virtual double pace() const noexcept { return 1.0; }

  // Tells of each source how it is doing; `lidar_packets` is what became of the lidar's. Both
  // outlive this. Once, before health is first asked for.
  virtual void add_sources(HealthMonitor& health, const SequencerCounters& lidar_packets) const = 0;
  [[nodiscard]] virtual RecordedTotals recorded() const noexcept { return {}; }

  // What is taken as input, in the log; once a second, what has changed; at the end, what was odd.
  virtual void log_start() const = 0;
  virtual void log_changes() {}
  virtual void log_end() const = 0;
  // After the end: throws std::runtime_error of one line when nothing of use came.
  virtual void check_content() const = 0;

 protected:
  // Release stores after a source's last commit; acquire loads in the consumers (Worker::run,
  // ImuPublishing::run).
  std::atomic<bool> lidar_ended_{false};
  std::atomic<bool> imu_ended_{false};
};

}  // namespace convexcut::daemon
