// SPDX-License-Identifier: Apache-2.0
#include "replay/watch_report.hpp"

#include <algorithm>
#include <array>

#include "replay/health_report.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {
namespace {

double rate_hz(std::uint64_t count, Duration elapsed) {
  const double seconds = std::chrono::duration<double>(elapsed).count();
  return seconds > 0.0 ? static_cast<double>(count) / seconds : 0.0;
}

// A daemon that was restarted counts from zero again.
std::uint64_t increase(std::uint64_t from, std::uint64_t to) { return to >= from ? to - from : to; }

std::string fixed(double value, int decimals) { return format("%.*f", decimals, value); }

std::string right_aligned(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

// The columns of a line, as in watch_header().
constexpr std::array<std::size_t, 11> kWidths{9, 7, 7, 6, 7, 6, 7, 7, 6, 7, 9};
constexpr std::array<std::size_t, 3> kBarsBefore{3, 6, 9};

std::string table_row(const std::array<std::string, kWidths.size()>& cells,
                      const std::string& state = "") {
  std::string row;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (std::count(kBarsBefore.begin(), kBarsBefore.end(), i) != 0) row += " |";
    if (i > 0) row += ' ';
    row += right_aligned(cells[i], kWidths[i]);
  }
  return row + (state.empty() ? "" : " | " + state) + '\n';
}

}  // namespace

void WatchCounter::add_status(const convexcut_msg_dds__ScanStatus_& status) {
  if (!last_) last_ = status;
  statuses_.push_back(status);
}

WatchInterval::Status WatchCounter::summarise() {
  WatchInterval::Status summary;
  std::vector<std::int64_t> latencies_ns;
  double points = 0.0;
  double structure = 0.0;
  for (const auto& status : statuses_) {
    points += status.points;
    structure += status.structure_points;
    summary.coverage += status.coverage;
    latencies_ns.push_back(status.latency_ns);
  }
  const auto scans = static_cast<double>(statuses_.size());
  summary.points_per_scan = points / scans;
  summary.structure_share = points > 0.0 ? structure / points : 0.0;
  summary.coverage /= scans;
  std::sort(latencies_ns.begin(), latencies_ns.end());
  summary.latency_p50 = Duration{latencies_ns[(latencies_ns.size() - 1) / 2]};
  summary.latency_max = Duration{latencies_ns.back()};
  const auto& now = statuses_.back();
  summary.late_scans = increase(last_->late_scans_total, now.late_scans_total);
  summary.lost_packets = increase(last_->lost_packets_total, now.lost_packets_total);
  summary.lost_imu_samples = increase(last_->lost_imu_samples_total, now.lost_imu_samples_total);
  return summary;
}

WatchInterval WatchCounter::finish(Duration elapsed) {
  WatchInterval interval;
  interval.structure_hz = rate_hz(structure_, elapsed);
  interval.points_hz = rate_hz(points_, elapsed);
  interval.imu_hz = rate_hz(imu_, elapsed);
  interval.health = health_;
  anything_came_ = anything_came_ || health_ || structure_ + points_ + imu_ + statuses_.size() > 0;
  if (!statuses_.empty()) {
    interval.status = summarise();
    last_ = statuses_.back();
  }
  structure_ = points_ = imu_ = 0;
  statuses_.clear();
  return interval;
}

std::string watch_header() {
  return table_row({"structure", "points", "imu", "points", "struct.", "cover.", "latency", "max",
                    "late", "lost", "lost IMU"}) +
         table_row(
             {"Hz", "Hz", "Hz", "a scan", "%", "%", "p50 ms", "ms", "scans", "packets", "samples"});
}

std::string watch_line(const WatchInterval& interval) {
  std::array<std::string, kWidths.size()> cells;
  cells.fill("-");
  cells[0] = fixed(interval.structure_hz, 1);
  cells[1] = fixed(interval.points_hz, 1);
  cells[2] = fixed(interval.imu_hz, 1);
  if (interval.status) {
    const WatchInterval::Status& status = *interval.status;
    cells[3] = fixed(status.points_per_scan, 0);
    cells[4] = fixed(100.0 * status.structure_share, 1);
    cells[5] = fixed(100.0 * status.coverage, 1);
    cells[6] = fixed(milliseconds(status.latency_p50), 2);
    cells[7] = fixed(milliseconds(status.latency_max), 2);
    cells[8] = std::to_string(status.late_scans);
    cells[9] = std::to_string(status.lost_packets);
    cells[10] = std::to_string(status.lost_imu_samples);
  }
  return table_row(cells, interval.health ? state_and_reasons(*interval.health) : "");
}

std::string watch_json(const WatchInterval& interval, std::uint32_t publishers) {
  JsonObject json;
  json.add("publishers", std::uint64_t{publishers})
      .add("structure_hz", interval.structure_hz, 2)
      .add("points_hz", interval.points_hz, 2)
      .add("imu_hz", interval.imu_hz, 2);
  if (interval.status) {
    const WatchInterval::Status& status = *interval.status;
    json.add("points_per_scan", status.points_per_scan, 1)
        .add("structure_share", status.structure_share, 4)
        .add("coverage", status.coverage, 4)
        .add("latency_p50_ms", milliseconds(status.latency_p50), 3)
        .add("latency_max_ms", milliseconds(status.latency_max), 3)
        .add("late_scans", status.late_scans)
        .add("lost_packets", status.lost_packets)
        .add("lost_imu_samples", status.lost_imu_samples);
  }
  if (interval.health) json.add("health", health_json(*interval.health));
  return json.text() + "\n";
}

}  // namespace convexcut::replay
