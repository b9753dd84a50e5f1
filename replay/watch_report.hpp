// SPDX-License-Identifier: Apache-2.0
//
// What `convexcut watch` counts and prints, apart from DDS and time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "daemon/dds/ros2.h"
#include "daemon/health/snapshot.hpp"

namespace convexcut::replay {

// One interval, usually a second.
struct WatchInterval {
  double structure_hz = 0.0;  // messages that arrived here, by topic
  double points_hz = 0.0;
  double imu_hz = 0.0;

  // From the daemon's status messages; absent when none arrived.
  struct Status {
    double points_per_scan = 0.0;
    double structure_share = 0.0;  // 0 … 1
    double coverage = 0.0;         // 0 … 1, mean
    Duration latency_p50{};
    Duration latency_max{};
    // In this interval; from the start of watching in the first one.
    std::uint64_t late_scans = 0;
    std::uint64_t lost_packets = 0;
    std::uint64_t lost_imu_samples = 0;
  };
  std::optional<Status> status;

  // The newest that came, in this interval or before; absent until one does.
  std::optional<daemon::HealthSnapshot> health;

  [[nodiscard]] bool anything_came() const noexcept {
    return structure_hz + points_hz + imu_hz > 0.0 || status || health;
  }
};

class WatchCounter {
 public:
  void add_structure() noexcept { ++structure_; }
  void add_points() noexcept { ++points_; }
  void add_imu() noexcept { ++imu_; }
  void add_status(const convexcut_msg_dds__ScanStatus_& status);

  void set_health(daemon::HealthSnapshot health) { health_ = std::move(health); }
  // The daemon is gone: what it said is no longer so.
  void forget_health() noexcept { health_.reset(); }
  [[nodiscard]] const std::optional<daemon::HealthSnapshot>& health() const noexcept {
    return health_;
  }

  [[nodiscard]] bool anything_came() const noexcept { return anything_came_; }
  // Ends the interval and starts the next.
  [[nodiscard]] WatchInterval finish(Duration elapsed);

 private:
  [[nodiscard]] WatchInterval::Status summarise();

  std::uint64_t structure_ = 0;
  std::uint64_t points_ = 0;
  std::uint64_t imu_ = 0;
  bool anything_came_ = false;
  std::vector<convexcut_msg_dds__ScanStatus_> statuses_;
  // The last of the interval before: totals are counted from it.
  std::optional<convexcut_msg_dds__ScanStatus_> last_;
  std::optional<daemon::HealthSnapshot> health_;
};

[[nodiscard]] std::string watch_header();
[[nodiscard]] std::string watch_line(const WatchInterval& interval);
[[nodiscard]] std::string watch_json(const WatchInterval& interval, std::uint32_t publishers);

}  // namespace convexcut::replay
