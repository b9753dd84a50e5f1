// SPDX-License-Identifier: Apache-2.0
#include "replay/info/lidar_info.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "daemon/sources/driver_options.hpp"
#include "daemon/sources/recordings.hpp"
#include "drivers/velodyne/model.hpp"
#include "replay/info/info_text.hpp"
#include "replay/info/whole_recording.hpp"

namespace convexcut::replay {
namespace {

// In a terminal, so many revolutions are listed one by one.
constexpr std::size_t kListedRevolutions = 12;

const char* name_of(PpsState state) {
  switch (state) {
    case PpsState::absent:
      return "absent";
    case PpsState::synchronising:
      return "synchronising";
    case PpsState::locked:
      return "locked";
    case PpsState::error:
      return "error";
    case PpsState::unknown:
      return "unknown";
  }
  return "unknown";
}

const char* name_of(ScanEnd end) {
  switch (end) {
    case ScanEnd::cut:
      return "cut";
    case ScanEnd::timeout:
      return "timeout";
    case ScanEnd::end_of_input:
      return "end of recording";
    case ScanEnd::no_data:
      return "no data";
  }
  return "";
}

}  // namespace

LidarInfo::LidarInfo(const std::filesystem::path& file, const config::Lidar& settings)
    : file_(file),
      inspector_(Azimuth::from_degrees(settings.cut_azimuth)),
      recording_(file, daemon::lidar_driver_options(settings), inspector_) {
  read_whole(recording_, "lidar");
  inspector_.finish();
  if (counters().data_packets.value() == 0) {
    throw std::runtime_error(daemon::no_lidar_packets(file, recording_));
  }
}

void LidarInfo::print() const {
  const velodyne::LidarCounters& c = counters();
  std::printf("%s: lidar\n", file_.c_str());
  std::printf("  time         %s, %.3f s\n", utc(inspector_.first()).c_str(), seconds(duration()));
  std::printf(
      "  model        %s%s, %s return\n", model(),
      c.product_differs.value() > 0 ? " (told by its timing: the product byte differs)" : "",
      inspector_.dual_return() ? "dual" : "single");
  std::printf("  packets      %s data (%.1f/s), %s position (%.1f/s), %s foreign, %s malformed\n",
              grouped(c.data_packets.value()).c_str(),
              per_second(c.data_packets.value(), inspector_.sensor_span()),
              grouped(c.position_packets.value()).c_str(),
              per_second(c.position_packets.value(), duration()),
              grouped(c.foreign.value()).c_str(), grouped(malformed()).c_str());
  std::printf("  order        %s lost, %s duplicate, %s reordered, %s late\n",
              grouped(order().lost.value()).c_str(), grouped(order().duplicates.value()).c_str(),
              grouped(order().reordered.value()).c_str(), grouped(order().late.value()).c_str());
  print_clock(inspector_.clock());
  std::printf("  pps          %s%s\n", name_of(inspector_.pps()), sentence().c_str());
  std::printf("  rotor        %.2f Hz\n", inspector_.rotor_hz());
  std::printf("  returns      %s\n", grouped(c.returns.value()).c_str());
  print_revolutions();
}

JsonObject LidarInfo::json() const {
  const velodyne::LidarCounters& c = counters();
  std::vector<JsonObject> revolutions;
  for (const LidarInspector::Revolution& r : inspector_.revolutions()) {
    revolutions.push_back(JsonObject()
                              .add("firings", std::uint64_t{r.firings})
                              .add("returns", std::uint64_t{r.returns})
                              .add("coverage", r.coverage, 4)
                              .add("end", name_of(r.end)));
  }
  return JsonObject()
      .add("file", file_.string())
      .add("kind", "lidar")
      .add("model", model())
      .add("dual_return", inspector_.dual_return())
      .add("start_ns", static_cast<std::uint64_t>(to_ns(inspector_.first())))
      .add("duration_s", seconds(duration()), 6)
      .add("data_packets", c.data_packets.value())
      .add("position_packets", c.position_packets.value())
      .add("foreign", c.foreign.value())
      .add("malformed", malformed())
      .add("lost", order().lost.value())
      .add("duplicates", order().duplicates.value())
      .add("reordered", order().reordered.value())
      .add("late", order().late.value())
      .add("pps", name_of(inspector_.pps()))
      .add("rotor_hz", inspector_.rotor_hz(), 3)
      .add("returns", c.returns.value())
      .add("clock", clock_json(inspector_.clock()))
      .add("revolutions", revolutions);
}

const char* LidarInfo::model() const {
  const auto id = recording_.driver().model();
  return id ? velodyne::model_of(*id).name.data() : "unknown";
}

std::uint64_t LidarInfo::malformed() const {
  const velodyne::LidarCounters& c = counters();
  return c.wrong_length.value() + c.wrong_block_flag.value() + c.azimuth_out_of_range.value() +
         c.timestamp_out_of_range.value() + c.no_sentence.value() + c.model_unknown.value();
}

std::string LidarInfo::sentence() const {
  const auto& position = recording_.driver().position();
  if (!position) return ", no position packets";
  const velodyne::NmeaFix& fix = position->fix;
  if (position->nmea_status != velodyne::NmeaStatus::ok) return ", no usable NMEA sentence";
  std::string text = std::string(", last NMEA ") + (fix.valid ? "valid" : "without a fix");
  if (fix.date && fix.time_of_day) {
    text += ", " +
            utc(HostTime{std::chrono::sys_days{*fix.date}.time_since_epoch()} + *fix.time_of_day);
  }
  return text;
}

void LidarInfo::print_revolutions() const {
  const auto& all = inspector_.revolutions();
  std::printf("  scans        %zu\n", all.size());
  for (std::size_t i = 0; i < std::min(all.size(), kListedRevolutions); ++i) {
    std::printf("    %6zu  %5u firings  %7s returns  coverage %.3f  %s\n", i, all[i].firings,
                grouped(all[i].returns).c_str(), all[i].coverage, name_of(all[i].end));
  }
  if (all.size() > kListedRevolutions) {
    std::printf("    ... and %zu more (--json lists them all)\n", all.size() - kListedRevolutions);
  }
}

}  // namespace convexcut::replay
