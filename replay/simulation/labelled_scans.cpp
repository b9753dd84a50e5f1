// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/labelled_scans.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/scan/levelling.hpp"
#include "core/sink.hpp"
#include "daemon/pipeline/lidar_input.hpp"
#include "daemon/pipeline/pipeline.hpp"
#include "daemon/sources/driver_options.hpp"
#include "drivers/velodyne/lidar_driver.hpp"
#include "drivers/velodyne/model.hpp"
#include "drivers/xsens/imu_driver.hpp"
#include "replay/simulation/stream.hpp"
#include "replay/simulation/wire/serial_line.hpp"

namespace convexcut::simulation {
namespace {

class ImuInput final : public Sink<ImuSample> {
 public:
  explicit ImuInput(daemon::Pipeline& pipeline) : pipeline_(pipeline) {}
  [[nodiscard]] ImuSample* claim() noexcept override { return &sample_; }
  void commit() noexcept override { pipeline_.on_imu(sample_); }

 private:
  daemon::Pipeline& pipeline_;
  ImuSample sample_;
};

config::Config settled(config::Config config, const SimulationOptions& simulation) {
  config.lidar.model = config::LidarModel::hdl32e;
  config.imu.baud = simulation.serial_imu.baud;
  config.mount.orientation = config::MountOrientation::imu;
  return config;
}

daemon::PipelineOptions pipeline_options(const config::Config& config) {
  daemon::PipelineOptions options = daemon::pipeline_options(config, 1);
  options.max_returns_per_scan = daemon::kMostSingleReturnsPerScan;
  if (options.cut.echoes == CutOptions::Echoes::both) {
    options.max_returns_per_scan = daemon::kMostReturnsPerScan;
  }
  return options;
}

// With perfect levelling all but the error of gravity is forgiven.
ImuErrors imu_errors(const LabelledScanOptions& options) {
  if (options.levelling == Levelling::imu) return options.simulation.imu_errors;
  ImuErrors errors = kIdealImu;
  errors.gravity = options.simulation.imu_errors.gravity;
  return errors;
}

}  // namespace

// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): in the order of construction
class LabelledScans::Run {
 public:
  Run(Scene scene, const LabelledScanOptions& options)
      : options_(options),
        config_(settled(options.config, options.simulation)),
        scene_(std::move(scene)),
        motion_(options.simulation.rig, options.simulation.seed),
        imu_(motion_, imu_errors(options), options.simulation.seed),
        stream_(scene_, options.simulation),
        max_points_(pipeline_options(config_).max_returns_per_scan),
        counter_(options.simulation.link, options.simulation.seed, kNetworkStream),
        pipeline_(pipeline_options(config_)),
        lidar_input_(pipeline_),
        imu_input_(pipeline_),
        lidar_driver_(daemon::lidar_driver_options(config_.lidar), lidar_input_),
        imu_driver_(daemon::imu_driver_options(config_.imu), imu_input_),
        line_(options.simulation.serial_imu.baud) {
    if (options.levelling == Levelling::imu) record_imu();
  }

  [[nodiscard]] bool next(LabelledScan& out) {
    while (true) {
      reserve(slot_, max_points_);  // `out` may have taken its memory
      while (!pipeline_.level_next(now_, slot_)) {
        if (!advance()) return false;
      }
      if (options_.whole_revolutions && !is_whole(slot_)) continue;
      std::swap(out.scan, slot_);
      label(out);
      return true;
    }
  }

  [[nodiscard]] Pose pose_at(HostTime time) const noexcept {
    return motion_.pose_at(time - kStart);
  }
  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }

 private:
  static bool is_whole(const LevelledScan& scan) noexcept {
    return scan.end == ScanEnd::cut && scan.index > 0;
  }

  void record_imu() {
    const SimulationOptions& simulation = options_.simulation;
    Random noise(simulation.seed, kSerialImuStream);
    Random reading(simulation.seed, kReadsStream);
    send_samples(
        simulation.serial_imu, [this](Duration t) { return imu_.state(t); }, kStart,
        simulation.imu_period(), noise, line_);
    reads_ = line_.reads(reading);
  }

  // One packet of the lidar, after all of the IMU that came before it. False at the end.
  [[nodiscard]] bool advance() {
    if (finished_) return false;
    const bool more =
        stream_.next([this](const SimulatedFiring& f) { firings_.push_back(f); },
                     [this](const Datagram& datagram) {
                       deliver_imu(datagram.stamp);
                       lidar_driver_.on_datagram(datagram.payload, datagram.port, datagram.stamp);
                       now_ = std::max(now_, datagram.stamp);
                     });
    if (more) return true;
    finished_ = true;
    deliver_imu(HostTime::max());
    lidar_driver_.flush();
    pipeline_.end_of_imu();
    pipeline_.end_of_lidar();
    return true;
  }

  void deliver_imu(HostTime until) {
    if (options_.levelling == Levelling::truth) return deliver_truth(until);
    for (; next_read_ < reads_.size() && reads_[next_read_].stamp <= until; ++next_read_) {
      imu_driver_.on_bytes(reads_[next_read_].bytes, reads_[next_read_].stamp);
    }
  }

  // Samples that arrive when they are taken. A scan waits for one behind its last firing.
  void deliver_truth(HostTime until) {
    const Period period = options_.simulation.imu_period();
    for (; true_sample_ < period.length && kStart + period.from + true_sample_ <= until;
         true_sample_ += kTruthPeriod) {
      const Duration t = period.from + true_sample_;
      ImuSample sample;
      sample.arrival = kStart + t;
      sample.q_level_from_imu = imu_.state(t).q_level_from_imu;
      sample.has_orientation = true;
      pipeline_.on_imu(sample);
    }
  }

  // The sensor's own count of a point tells which laser of which firing it is of: the packets'
  // stamps are cut to microseconds, firings are 46 µs apart, and their last laser fires 9 µs
  // before the next.
  [[nodiscard]] std::int64_t firing_of(const LevelledScan& scan, std::size_t point) const {
    const Duration since_start = sensor_elapsed(scan) + Duration{scan.time_ns[point]};
    return (since_start + kStampRounding).count() / LidarSimulator::kFiringPeriod.count();
  }

  // What the sensor had counted at the scan's first firing since the start. The counter wraps
  // every hour; the stamp tells which it was.
  [[nodiscard]] Duration sensor_elapsed(const LevelledScan& scan) const {
    const Duration start = std::chrono::microseconds{counter_.counter(Duration{0}).count};
    const Duration counted = (scan.first_firing.time_since_epoch() - start) % kHour;
    const auto hours = std::llround(static_cast<double>((scan.stamp - kStart - counted).count()) /
                                    static_cast<double>(kHour.count()));
    return counted + hours * kHour;
  }

  void label(LabelledScan& out) {
    const LevelledScan& scan = out.scan;
    const std::size_t n = scan.size();
    out.label.resize(n);
    out.surface.resize(n);
    out.flags.resize(n);
    out.range_m.resize(n);
    out.true_range_m.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const SimulatedReturn& truth = return_of(scan, i);
      out.label[i] = truth.label;
      out.surface[i] = truth.surface;
      out.flags[i] = truth.flags;
      out.range_m[i] = static_cast<float>(truth.range_2mm * 0.002);
      out.true_range_m[i] = truth.true_range_m;
    }
    if (n == 0) return;
    // Packets that were overtaken are delivered soon: the scan before is all that may be asked for.
    const auto oldest = static_cast<std::uint64_t>(std::max<std::int64_t>(firing_of(scan, 0), 0));
    while (!firings_.empty() && firings_.front().index < oldest) firings_.pop_front();
  }

  [[nodiscard]] const SimulatedReturn& return_of(const LevelledScan& scan,
                                                 std::size_t point) const {
    const std::int64_t index =
        firing_of(scan, point) - static_cast<std::int64_t>(firings_.front().index);
    const SimulatedFiring& firing = firings_.at(static_cast<std::size_t>(index));
    const std::size_t ring = scan.ring[point];
    const std::size_t laser = ring < 16 ? 2 * ring : 2 * (ring - 16) + 1;
    const SimulatedReturn& first = firing.returns[0][laser];
    const SimulatedReturn& second = firing.returns[1][laser];
    const double range = Vec3f(scan.x[point], scan.y[point], scan.z[point]).cast<double>().norm();
    const auto off = [range](const SimulatedReturn& r) {
      return std::abs(r.range_2mm * 0.002 - range);
    };
    const SimulatedReturn& nearest = off(first) <= off(second) ? first : second;
    if (off(nearest) > kRangeProof) {
      throw std::logic_error("a simulated point does not belong to the firing of its time");
    }
    return nearest;
  }

  static constexpr Duration kTruthPeriod{2'500'000};  // 400 Hz
  static constexpr Duration kStampRounding{1'000};
  static constexpr double kRangeProof = 0.0009;  // m; ranges are 2 mm apart

  LabelledScanOptions options_;
  config::Config config_;
  Scene scene_;
  RigMotion motion_;
  RigImu imu_;
  LidarStream stream_;
  std::size_t max_points_;
  LidarLink counter_;  // asked for the counter only
  daemon::Pipeline pipeline_;
  daemon::LidarInput lidar_input_;
  ImuInput imu_input_;
  velodyne::LidarDriver lidar_driver_;
  xsens::ImuDriver imu_driver_;
  SerialLine line_;
  std::vector<SerialRead> reads_;
  std::size_t next_read_ = 0;
  Duration true_sample_{0};
  std::deque<SimulatedFiring> firings_;
  LevelledScan slot_;
  HostTime now_ = kStart;
  bool finished_ = false;
};

LabelledScans::LabelledScans(const Scene& scene, const LabelledScanOptions& options)
    : run_(std::make_unique<Run>(scene, options)) {}
LabelledScans::LabelledScans(LabelledScans&&) noexcept = default;
LabelledScans& LabelledScans::operator=(LabelledScans&&) noexcept = default;
LabelledScans::~LabelledScans() = default;

bool LabelledScans::next(LabelledScan& out) { return run_->next(out); }
Pose LabelledScans::pose_at(HostTime time) const noexcept { return run_->pose_at(time); }
const Scene& LabelledScans::scene() const noexcept { return run_->scene(); }

}  // namespace convexcut::simulation
