// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/daemon/live/live_daemon.hpp"

namespace convexcut::test {

// A source counts as streaming when it has done so for 1 s: two seconds and room for a busy host.
inline constexpr double kRecovery = 3.0;

class LiveFault : public LiveDaemon {
 protected:
  // A daemon without an IMU whose ports are open, so that it hears the first packet.
  void start_listening_daemon(std::vector<std::string> settings, const ProgramLimits& limits = {}) {
    settings.emplace_back("mount.orientation=fixed");
    start_daemon(std::move(settings), limits);
    becomes("lidar", "waiting", 10.0);
  }
  // The lidar's recording, played once to a daemon without an IMU.
  void play(const std::vector<std::string>& faults) {
    start_listening_daemon({});
    sent_ = run_program("convexcut", with(replay_of_lidar(), faults));
    EXPECT_EQ(sent_.status, 0) << sent_.err;
    std::this_thread::sleep_for(std::chrono::milliseconds{300});  // the last scan's time
    stop();
  }
  void stop() {
    run_ = daemon_->stop();
    EXPECT_EQ(run_.status, 0) << run_.err;
  }

  [[nodiscard]] long ended_with(const std::string& key) const {
    return logged(run_.err, "info end", key);
  }
  [[nodiscard]] long scans() const { return ended_with("scans") - ended_with("empty"); }
  void expect_results_all_the_time() const {
    EXPECT_NEAR(static_cast<double>(logged(run_.err, "info timing", "results")),
                static_cast<double>(logged(run_.err, "info timing", "run_ms")) / 100.0, 3.0)
        << run_.err;
  }
  void expect_nothing_dropped_here() const {
    EXPECT_EQ(ended_with("kernel_drops"), 0) << run_.err;
    EXPECT_EQ(ended_with("ring_overruns"), 0) << run_.err;
  }
  // As `convexcut info` reads them.
  [[nodiscard]] long packets_recorded_in(const std::string& file) const {
    const ProgramResult info =
        run_program("convexcut", {"info", "--json", "--lidar", path(file).string(), "--set",
                                  "lidar.data_port=" + std::to_string(data_port_), "--set",
                                  "lidar.position_port=" + std::to_string(position_port_)});
    EXPECT_EQ(info.status, 0) << info.err;
    return counted(info.out, "data_packets");
  }

  ProgramResult sent_;
  ProgramResult run_;
};

}  // namespace convexcut::test
