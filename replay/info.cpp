// SPDX-License-Identifier: Apache-2.0
#include "replay/info.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>

#include "drivers/recording/can_recording.hpp"
#include "drivers/recording/imu_recording.hpp"
#include "drivers/recording/lidar_recording.hpp"
#include "drivers/velodyne/model.hpp"
#include "drivers/xsens/mt_data_id.hpp"
#include "drivers/xsens/mt_statistics.hpp"
#include "replay/lidar_inspector.hpp"
#include "replay/progress_bar.hpp"
#include "replay/text.hpp"

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

void run(recording::RecordedStream& stream, const char* what) {
  ProgressBar bar(what);
  while (stream.next_stamp()) {
    stream.deliver();
    bar.update(stream.bytes_read(), stream.bytes_total());
  }
  stream.finish();
}

void warn(const recording::RecordedStream& stream) {
  if (const std::string problem = stream.problem(); !problem.empty()) {
    std::fprintf(stderr, "warning: %s\n", problem.c_str());
  }
}

double per_second(std::uint64_t count, Duration span) {
  return span > Duration::zero() ? static_cast<double>(count) / seconds(span) : 0.0;
}

JsonObject clock_json(const ClockState& clock) {
  return JsonObject()
      .add("offset_s", seconds(clock.offset), 6)
      .add("skew_ppm", clock.skew_ppm, 2)
      .add("jitter_us", seconds(clock.jitter) * 1e6, 1)
      .add("steps", std::uint64_t{clock.steps})
      .add("locked", clock.locked);
}

void print_clock(const ClockState& clock) {
  std::printf(
      "  clock        host - sensor %.6f s, jitter %.0f us, skew %s, %u steps\n",
      seconds(clock.offset), seconds(clock.jitter) * 1e6,
      clock.locked ? format("%.1f ppm", clock.skew_ppm).c_str() : "unknown (too short a recording)",
      clock.steps);
}

class LidarInfo {
 public:
  LidarInfo(const std::filesystem::path& file, const config::Lidar& settings)
      : file_(file),
        inspector_(Azimuth::from_degrees(settings.cut_azimuth)),
        recording_(file, daemon::lidar_driver_options(settings), inspector_) {
    run(recording_, "lidar");
    inspector_.finish();
    warn(recording_);
    if (counters().data_packets.value() == 0) {
      throw std::runtime_error(daemon::no_lidar_packets(file, recording_));
    }
  }

  void print() const {
    const velodyne::LidarCounters& c = counters();
    std::printf("%s: lidar\n", file_.c_str());
    std::printf("  time         %s, %.3f s\n", utc(inspector_.first()).c_str(),
                seconds(duration()));
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

  [[nodiscard]] JsonObject json() const {
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

 private:
  [[nodiscard]] const velodyne::LidarCounters& counters() const {
    return recording_.driver().counters();
  }
  [[nodiscard]] const SequencerCounters& order() const { return inspector_.order(); }
  [[nodiscard]] Duration duration() const { return inspector_.last() - inspector_.first(); }
  [[nodiscard]] const char* model() const {
    const auto id = recording_.driver().model();
    return id ? velodyne::model_of(*id).name.data() : "unknown";
  }
  [[nodiscard]] std::uint64_t malformed() const {
    const velodyne::LidarCounters& c = counters();
    return c.wrong_length.value() + c.wrong_block_flag.value() + c.azimuth_out_of_range.value() +
           c.timestamp_out_of_range.value() + c.no_sentence.value() + c.model_unknown.value();
  }
  [[nodiscard]] std::string sentence() const {
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
  void print_revolutions() const {
    const auto& all = inspector_.revolutions();
    std::printf("  scans        %zu\n", all.size());
    for (std::size_t i = 0; i < std::min(all.size(), kListedRevolutions); ++i) {
      std::printf("    %6zu  %5u firings  %7s returns  coverage %.3f  %s\n", i, all[i].firings,
                  grouped(all[i].returns).c_str(), all[i].coverage, name_of(all[i].end));
    }
    if (all.size() > kListedRevolutions) {
      std::printf("    ... and %zu more (--json lists them all)\n",
                  all.size() - kListedRevolutions);
    }
  }

  std::filesystem::path file_;
  LidarInspector inspector_;
  recording::LidarRecording recording_;
};

// Follows an IMU's samples.
class SampleInspector final : public Sink<ImuSample> {
 public:
  [[nodiscard]] ImuSample* claim() noexcept override { return &sample_; }
  void commit() noexcept override {
    ++samples_;
    orientations_ += sample_.has_orientation ? 1 : 0;
    first_ = std::min(first_, sample_.arrival);
    last_ = std::max(last_, sample_.arrival);
    if (sample_.has_device_time) clock_.observe(sample_.device_time, sample_.arrival);
  }
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::uint64_t orientations() const { return orientations_; }
  [[nodiscard]] HostTime first() const { return first_; }
  [[nodiscard]] Duration duration() const {
    return samples_ > 0 ? last_ - first_ : Duration::zero();
  }
  [[nodiscard]] double rate_hz() const {
    return samples_ > 1 ? per_second(samples_ - 1, duration()) : 0.0;
  }
  [[nodiscard]] ClockState clock() const { return clock_.state(); }

 private:
  ImuSample sample_;
  std::uint64_t samples_ = 0;
  std::uint64_t orientations_ = 0;
  HostTime first_ = HostTime::max();
  HostTime last_ = HostTime::min();
  ClockMapping<ImuTime> clock_;
};

class ImuInfo {
 public:
  ImuInfo(const std::filesystem::path& file, const config::Imu& settings)
      : file_(file), recording_(file, daemon::imu_driver_options(settings), HostTime{}, samples_) {
    recording_.inspect(statistics_);
    run(recording_, "imu");
    warn(recording_);
    if (statistics_.xbus().frames.value() == 0) {
      throw std::runtime_error(file.string() +
                               ": no Xbus frames: expected the bytes of an MTi's "
                               "serial line, found " +
                               recording_.summary());
    }
  }

  void print() const {
    std::printf("%s: IMU over serial, %s\n", file_.c_str(),
                recording_.stamped() ? "stamped reads" : "raw stream without stamps");
    if (recording_.stamped()) {
      std::printf("  time         %s, %.3f s\n", utc(samples_.first()).c_str(),
                  seconds(samples_.duration()));
    } else {
      std::printf("  time         %.3f s by the device's clock\n", seconds(samples_.duration()));
    }
    std::printf("  device       %s\n", devices().c_str());
    std::printf("  frames       %s, %s checksum errors, %s bytes outside frames\n",
                grouped(statistics_.xbus().frames.value()).c_str(),
                grouped(statistics_.xbus().checksum_errors.value()).c_str(),
                grouped(statistics_.xbus().skipped_bytes.value()).c_str());
    std::printf("  samples      %s (%.1f Hz), %s with orientation, %s messages lost\n",
                grouped(samples_.samples()).c_str(), samples_.rate_hz(),
                grouped(samples_.orientations()).c_str(),
                grouped(recording_.counters().lost_messages.value()).c_str());
    if (recording_.stamped()) print_clock(samples_.clock());
    for (const auto& [id, item] : statistics_.items()) {
      const auto rate = item.rate_hz();
      std::printf("    0x%04X  %-36s %8s x  %s\n", id, xsens::describe_data_id(id).c_str(),
                  grouped(item.count).c_str(), rate ? format("%.1f Hz", *rate).c_str() : "");
    }
  }

  [[nodiscard]] JsonObject json() const {
    std::vector<JsonObject> items;
    for (const auto& [id, item] : statistics_.items()) {
      items.push_back(JsonObject()
                          .add("id", format("0x%04X", id))
                          .add("name", xsens::describe_data_id(id))
                          .add("count", item.count)
                          .add("rate_hz", item.rate_hz().value_or(0.0), 2));
    }
    return JsonObject()
        .add("file", file_.string())
        .add("kind", "imu")
        .add("stamped", recording_.stamped())
        .add("frames", statistics_.xbus().frames.value())
        .add("checksum_errors", statistics_.xbus().checksum_errors.value())
        .add("skipped_bytes", statistics_.xbus().skipped_bytes.value())
        .add("samples", samples_.samples())
        .add("orientations", samples_.orientations())
        .add("lost", recording_.counters().lost_messages.value())
        .add("duration_s", seconds(samples_.duration()), 6)
        .add("rate_hz", samples_.rate_hz(), 2)
        .add("clock", clock_json(samples_.clock()))
        .add("items", items);
  }

 private:
  [[nodiscard]] std::string devices() const {
    std::string text;
    for (const std::string& code : statistics_.product_codes()) text += code + " ";
    for (const std::string& id : statistics_.device_ids()) text += "id " + id + " ";
    return text.empty() ? "not stated in the recording" : text;
  }

  std::filesystem::path file_;
  SampleInspector samples_;
  xsens::MtStatistics statistics_;
  recording::ImuRecording recording_;
};

class CanInfo {
 public:
  CanInfo(const std::filesystem::path& file, const config::Config& config)
      : file_(file), recording_(file, daemon::bus_options(config), samples_, angles_) {
    run(recording_, "can");
    warn(recording_);
    if (recording_.frames() == 0) {
      throw std::runtime_error(file.string() +
                               ": no CAN frames in it: expected a candump -L log or a "
                               "capture of link type CAN_SOCKETCAN (227)");
    }
  }

  void print() const {
    std::printf("%s: CAN\n", file_.c_str());
    std::printf("  frames       %s\n", recording_.summary().c_str());
    if (samples_.samples() > 0) {
      std::printf("  time         %s, %.3f s\n", utc(samples_.first()).c_str(),
                  seconds(samples_.duration()));
    }
    std::printf("  IMU samples  %s (%.1f Hz), %s with orientation\n",
                grouped(samples_.samples()).c_str(), samples_.rate_hz(),
                grouped(samples_.orientations()).c_str());
    if (samples_.samples() > 0) print_clock(samples_.clock());
    if (recording_.encoder() != nullptr) {
      std::printf("  angles       %s of the stage\n", grouped(angles()).c_str());
    }
    for (const auto& [id, count] : recording_.frames_by_id()) {
      std::printf("    0x%03X  %8s x\n", id, grouped(count).c_str());
    }
  }

  [[nodiscard]] JsonObject json() const {
    std::vector<JsonObject> ids;
    for (const auto& [id, count] : recording_.frames_by_id()) {
      ids.push_back(JsonObject().add("id", format("0x%03X", id)).add("count", count));
    }
    return JsonObject()
        .add("file", file_.string())
        .add("kind", "can")
        .add("frames", recording_.frames())
        .add("samples", samples_.samples())
        .add("orientations", samples_.orientations())
        .add("rate_hz", samples_.rate_hz(), 2)
        .add("clock", clock_json(samples_.clock()))
        .add("angles", angles())
        .add("ids", ids);
  }

 private:
  [[nodiscard]] std::uint64_t angles() const {
    return recording_.encoder() != nullptr ? recording_.encoder()->counters().samples.value() : 0;
  }

  std::filesystem::path file_;
  SampleInspector samples_;
  daemon::NullSink<EncoderSample> angles_;
  recording::CanRecording recording_;
};

template <class Info>
void show(const Info& info, bool json, std::vector<JsonObject>& objects) {
  if (json) {
    objects.push_back(info.json());
  } else {
    info.print();
  }
}

}  // namespace

void info(const InfoOptions& options) {
  const daemon::RecordingPaths& paths = options.recordings;
  std::vector<JsonObject> objects;
  if (!paths.lidar.empty()) {
    show(LidarInfo(paths.lidar, options.config.lidar), options.json, objects);
  }
  if (!paths.imu.empty()) show(ImuInfo(paths.imu, options.config.imu), options.json, objects);
  if (!paths.can.empty()) show(CanInfo(paths.can, options.config), options.json, objects);
  if (options.json) {
    std::puts(JsonObject().add("recordings", objects).text().c_str());
  }
}

}  // namespace convexcut::replay
