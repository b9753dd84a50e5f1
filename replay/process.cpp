// SPDX-License-Identifier: Apache-2.0
#include "replay/process.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>

#include "daemon/pipeline/lidar_input.hpp"
#include "daemon/pipeline/pipeline.hpp"
#include "replay/progress_bar.hpp"
#include "replay/scan_output.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {
namespace {

// When the samples of one kind came.
class TimeSpan {
 public:
  void add(HostTime time) {
    first_ = std::min(first_, time);
    last_ = std::max(last_, time);
  }
  // "the IMU recording (… to …) and "; nothing without samples.
  [[nodiscard]] std::string text(const char* of_what) const {
    if (first_ > last_) return {};
    return std::string("the ") + of_what + " (" + utc(first_) + " to " + utc(last_) + ") and ";
  }

 private:
  HostTime first_ = HostTime::max();
  HostTime last_ = HostTime::min();
};

class ImuInput final : public Sink<ImuSample> {
 public:
  explicit ImuInput(daemon::Pipeline& pipeline) : pipeline_(pipeline) {}
  [[nodiscard]] ImuSample* claim() noexcept override { return &sample_; }
  void commit() noexcept override {
    span_.add(sample_.arrival);
    pipeline_.on_imu(sample_);
  }
  [[nodiscard]] const TimeSpan& span() const noexcept { return span_; }

 private:
  daemon::Pipeline& pipeline_;
  ImuSample sample_;
  TimeSpan span_;
};

class EncoderInput final : public Sink<EncoderSample> {
 public:
  explicit EncoderInput(daemon::Pipeline& pipeline) : pipeline_(pipeline) {}
  [[nodiscard]] EncoderSample* claim() noexcept override { return &sample_; }
  void commit() noexcept override {
    span_.add(sample_.arrival);
    pipeline_.on_encoder(sample_);
  }
  [[nodiscard]] const TimeSpan& span() const noexcept { return span_; }

 private:
  daemon::Pipeline& pipeline_;
  EncoderSample sample_;
  TimeSpan span_;
};

struct Totals {
  std::uint64_t scans = 0;
  std::uint64_t points = 0;
  std::uint64_t structure = 0;
  std::uint64_t dropped_no_orientation = 0;
  std::uint64_t scans_without_some_orientation = 0;
  std::uint64_t overflow = 0;
};

unsigned default_threads() { return std::clamp(std::thread::hardware_concurrency(), 1U, 4U); }

daemon::PipelineOptions pipeline_options(const ProcessOptions& options, unsigned threads) {
  daemon::PipelineOptions pipeline = daemon::pipeline_options(options.config, threads);
  pipeline.positions = daemon::recorded_positions(options.recordings);
  return pipeline;
}

class Run {
 public:
  explicit Run(const ProcessOptions& options)
      : options_(options),
        threads_(options.threads != 0 ? options.threads : default_threads()),
        pipeline_(pipeline_options(options, threads_)),
        lidar_input_(pipeline_),
        imu_input_(pipeline_),
        encoder_input_(pipeline_),
        recordings_(options.recordings, options.config, lidar_input_, imu_input_, encoder_input_),
        writer_(options.out, options.format),
        output_(writer_, daemon::Pipeline::kMaxReturnsPerScan) {}

  void all() {
    const auto started = std::chrono::steady_clock::now();
    ProgressBar bar("process");
    HostTime now = recordings_.first_stamp();
    const HostTime first = now;
    while (const auto stamp = recordings_.step()) {
      now = std::max(now, *stamp);
      take_ready_scans(now);
      bar.update(recordings_.bytes_read(), recordings_.bytes_total(),
                 std::to_string(totals_.scans) + " scans");
    }
    recordings_.finish();
    pipeline_.end_of_imu();
    pipeline_.end_of_encoder();
    pipeline_.end_of_lidar();
    take_ready_scans(now);
    recordings_.check_content();
    check_overlap();
    write_held_back();
    output_.finish();
    writer_.finish();
    recorded_ = now - first;
    elapsed_ = std::chrono::steady_clock::now() - started;
  }

  void report() const;

 private:
  void take_ready_scans(HostTime now) {
    while (pipeline_.next_scan(now, output_.slot())) {
      const LevelledScan& scan = output_.slot();
      add_to_totals(scan);
      const Duration latency = now - scan.last_firing;
      if (totals_.points == 0 && scan.dropped_no_orientation > 0) {
        // Until the first orientation there is nothing to write. If none ever comes, the recordings
        // do not belong together and no file shall be left.
        held_back_.push_back({scan, latency});
        continue;
      }
      write_held_back();
      output_.submit(latency);
    }
  }

  void write_held_back() {
    if (held_back_.empty()) return;
    // The slot holds the scan that came after them: it waits aside.
    LevelledScan newest = output_.slot();
    for (const HeldBack& held : held_back_) {
      output_.slot() = held.scan;
      output_.submit(held.latency);
    }
    held_back_.clear();
    output_.slot() = std::move(newest);
  }

  void add_to_totals(const LevelledScan& scan) {
    ++totals_.scans;
    totals_.points += scan.size();
    totals_.structure += scan.structure_points;
    totals_.dropped_no_orientation += scan.dropped_no_orientation;
    totals_.scans_without_some_orientation += scan.dropped_no_orientation > 0 ? 1 : 0;
    totals_.overflow += scan.overflow_returns;
  }

  void check_overlap() const {
    if (totals_.points > 0 || totals_.dropped_no_orientation == 0) return;
    throw std::runtime_error(imu_input_.span().text("IMU recording") +
                             encoder_input_.span().text("angles of the stage") +
                             "the lidar recording (from " + utc(first_lidar_) +
                             ") do not overlap in time: expected orientations during the lidar's "
                             "packets; for a raw .bin stream set --imu-start");
  }

  struct HeldBack {
    LevelledScan scan;
    Duration latency;
  };

  const ProcessOptions& options_;
  unsigned threads_;
  daemon::Pipeline pipeline_;
  daemon::LidarInput lidar_input_;
  ImuInput imu_input_;
  EncoderInput encoder_input_;
  daemon::Recordings recordings_;
  ScanWriter writer_;
  ScanOutput output_;
  std::vector<HeldBack> held_back_;
  Totals totals_;
  HostTime first_lidar_ = recordings_.lidar_start();
  Duration recorded_{};
  std::chrono::duration<double> elapsed_{};
};

void Run::report() const {
  const velodyne::LidarCounters& lidar = recordings_.lidar_driver().counters();
  const SequencerCounters& order = pipeline_.sequencer().counters();
  for (const std::string& warning : recordings_.warnings()) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
  if (totals_.dropped_no_orientation > 0) {
    std::fprintf(
        stderr,
        "warning: %s points of %s scans were dropped for want of an orientation at their time\n",
        grouped(totals_.dropped_no_orientation).c_str(),
        grouped(totals_.scans_without_some_orientation).c_str());
  }
  if (const std::uint64_t without = pipeline_.scans_without_position(); without > 0) {
    std::fprintf(stderr, "warning: %s of %s scans have no position: no pose of %s is near them\n",
                 grouped(without).c_str(), grouped(totals_.scans).c_str(),
                 options_.recordings.poses.c_str());
  }
  if (const std::size_t stale = writer_.stale_files(); stale > 0) {
    std::fprintf(stderr, "warning: %s still holds %zu scan files of an earlier run\n",
                 options_.out.c_str(), stale);
  }
  const double rate = elapsed_.count() > 0 ? seconds(recorded_) / elapsed_.count() : 0.0;
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const double peak_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
  if (options_.json) {
    JsonObject summary;
    summary.add("scans", totals_.scans)
        .add("points", totals_.points)
        .add("structure", totals_.structure)
        .add("packets", lidar.data_packets.value())
        .add("returns", lidar.returns.value())
        .add("lost_packets", order.lost.value())
        .add("duplicate_packets", order.duplicates.value())
        .add("reordered_packets", order.reordered.value())
        .add("late_packets", order.late.value())
        .add("dropped_no_orientation", totals_.dropped_no_orientation)
        .add("overflow_returns", totals_.overflow)
        .add("scans_without_position", pipeline_.scans_without_position())
        .add("recorded_s", seconds(recorded_), 6)
        .add("elapsed_s", elapsed_.count(), 6)
        .add("times_real_time", rate, 2)
        .add("threads", std::uint64_t{threads_})
        .add("peak_memory_mb", peak_mb, 1);
    std::puts(summary.text().c_str());
    return;
  }
  std::printf("recording    %.3f s, %s packets, %s lost, %s duplicate, %s late\n",
              seconds(recorded_), grouped(lidar.data_packets.value()).c_str(),
              grouped(order.lost.value()).c_str(), grouped(order.duplicates.value()).c_str(),
              grouped(order.late.value()).c_str());
  std::printf("scans        %s with %s points, %.1f %% structure\n", grouped(totals_.scans).c_str(),
              grouped(totals_.points).c_str(),
              totals_.points > 0 ? 100.0 * static_cast<double>(totals_.structure) /
                                       static_cast<double>(totals_.points)
                                 : 0.0);
  std::printf("written      %s\n", options_.out.c_str());
  std::printf("time         %.3f s = %.1f x real time, %u threads, at most %.0f MB\n",
              elapsed_.count(), rate, threads_, peak_mb);
}

}  // namespace

void process(const ProcessOptions& options) {
  Run run(options);
  run.all();
  run.report();
}

}  // namespace convexcut::replay
