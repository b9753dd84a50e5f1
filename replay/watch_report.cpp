// SPDX-License-Identifier: Apache-2.0
#include "replay/watch_report.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace convexcut::replay {
namespace {

double rate_hz(std::uint64_t count, Duration elapsed) {
  const double seconds = std::chrono::duration<double>(elapsed).count();
  return seconds > 0.0 ? static_cast<double>(count) / seconds : 0.0;
}

double milliseconds(Duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

// A daemon that was restarted counts from zero again.
std::uint64_t increase(std::uint64_t from, std::uint64_t to) { return to >= from ? to - from : to; }

template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 512> text;
  const int length = std::snprintf(text.data(), text.size(), format, values...);
  return {text.data(), static_cast<std::size_t>(std::max(length, 0))};
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
  anything_came_ = anything_came_ || structure_ + points_ + imu_ + statuses_.size() > 0;
  if (!statuses_.empty()) {
    interval.status = summarise();
    last_ = statuses_.back();
  }
  structure_ = points_ = imu_ = 0;
  statuses_.clear();
  return interval;
}

std::string watch_header() {
  return "structure  points     imu | points  struct. cover. | latency     max   late |    lost    "
         "lost\n"
         "       Hz      Hz      Hz | a scan       %      % |  p50 ms      ms  scans | packets "
         "IMU samp.\n";
}

std::string watch_line(const WatchInterval& interval) {
  const std::string rates =
      formatted("%9.1f %7.1f %7.1f |", interval.structure_hz, interval.points_hz, interval.imu_hz);
  if (!interval.status) {
    return rates + formatted(" %6s %7s %6s | %7s %7s %6s | %7s %9s\n", "-", "-", "-", "-", "-", "-",
                             "-", "-");
  }
  const WatchInterval::Status& status = *interval.status;
  return rates + formatted(" %6.0f %7.1f %6.1f | %7.2f %7.2f %6llu | %7llu %9llu\n",
                           status.points_per_scan, 100.0 * status.structure_share,
                           100.0 * status.coverage, milliseconds(status.latency_p50),
                           milliseconds(status.latency_max),
                           static_cast<unsigned long long>(status.late_scans),
                           static_cast<unsigned long long>(status.lost_packets),
                           static_cast<unsigned long long>(status.lost_imu_samples));
}

std::string watch_json(const WatchInterval& interval, std::uint32_t publishers) {
  std::string json =
      formatted(R"({"publishers":%u,"structure_hz":%.2f,"points_hz":%.2f,"imu_hz":%.2f)",
                publishers, interval.structure_hz, interval.points_hz, interval.imu_hz);
  if (interval.status) {
    const WatchInterval::Status& status = *interval.status;
    json += formatted(
        R"(,"points_per_scan":%.1f,"structure_share":%.4f,"coverage":%.4f,"latency_p50_ms":%.3f,)"
        R"("latency_max_ms":%.3f,"late_scans":%llu,"lost_packets":%llu,"lost_imu_samples":%llu)",
        status.points_per_scan, status.structure_share, status.coverage,
        milliseconds(status.latency_p50), milliseconds(status.latency_max),
        static_cast<unsigned long long>(status.late_scans),
        static_cast<unsigned long long>(status.lost_packets),
        static_cast<unsigned long long>(status.lost_imu_samples));
  }
  return json + "}\n";
}

}  // namespace convexcut::replay
