// SPDX-License-Identifier: Apache-2.0
//
// The way of the data, from decoded samples to a labelled scan, the same for the daemon and for
// `convexcut process`:
//
//   batches → unwrap and map time → put in order → cut into scans ┐
//   samples → map time → orientation track ───────────────────────┼→ level → cut → scan
//   angles of a turning stage → stage track ──────────────────────┘
//
// Knows no bytes, files, threads or topics. One thread calls it. RT after construction: allocates
// nothing, blocks only for the engine's own threads, throws nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "config/config.hpp"
#include "core/clock/clock_mapping.hpp"
#include "core/clock/hour_clock.hpp"
#include "core/convex_cut/engine.hpp"
#include "core/convex_cut/robust/robust_cut.hpp"
#include "core/encoder_sample.hpp"
#include "core/imu_sample.hpp"
#include "core/return_batch.hpp"
#include "core/scan/levelling.hpp"
#include "core/scan/orientation_track.hpp"
#include "core/scan/packet_sequencer.hpp"
#include "core/scan/position_track.hpp"
#include "core/scan/scan.hpp"
#include "core/scan/scan_cutter.hpp"
#include "core/scan/stage.hpp"
#include "daemon/pipeline/effort.hpp"

namespace convexcut::daemon {

// Where the host time of the lidar's firings comes from.
enum class LidarTimeSource : std::uint8_t {
  none,      // no packet yet
  envelope,  // estimated from arrival stamps
  pps,       // the sensor's own UTC: PPS locked, and not at odds with the host's clock
};

// One revolution at 5 Hz, the slowest of these sensors, with both echoes of every firing: 4340
// firings × 32 lasers × 2; and half of it, where one echo is taken.
inline constexpr std::size_t kMostReturnsPerScan = 280'000;
inline constexpr std::size_t kMostSingleReturnsPerScan = kMostReturnsPerScan / 2;

// What the angle of the stage is used for.
enum class StageUse : std::uint8_t {
  none,
  heading,      // instead of the IMU's heading; roll and pitch stay the IMU's
  orientation,  // on top of the fixed mount: level ← base is fixed, base ← lidar turns
};

struct PipelineOptions {
  CutOptions cut;
  config::Method method = config::Method::paper;
  ConvexCutParameters convex_cut;
  RobustParameters robust;
  bool learn_first = true;  // see RobustCut::label() and label_at_once()
  unsigned threads = 1;
  // What a scan has beyond it is dropped and counted in overflow_returns.
  std::size_t max_returns_per_scan = kMostReturnsPerScan;
  bool fixed_mount = false;
  Quaternion q_level_from_lidar = Quaternion::Identity();  // of the fixed mount, stage at angle 0
  Quaternion q_imu_from_lidar = Quaternion::Identity();
  Duration orientation_max_age = std::chrono::milliseconds{50};
  StageUse stage_use = StageUse::none;
  StageAxis stage_axis = StageAxis::rotation;
  Duration stage_max_age = std::chrono::milliseconds{100};
  // Of a recording whose poses are known beforehand; none: no scan has a position.
  std::shared_ptr<const PositionTrack> positions{};
  // How long after its last firing a scan waits for the orientation of its last points.
  Duration orientation_wait = std::chrono::milliseconds{50};
};

// The options that a configuration asks for. `threads` overrides convex_cut.threads when not 0.
[[nodiscard]] PipelineOptions pipeline_options(const config::Config& config, unsigned threads = 0);

class Pipeline {
 public:
  static constexpr std::size_t kMaxReturnsPerScan = kMostReturnsPerScan;
  static constexpr std::size_t kMaxFiringsPerScan = 8'800;

  // How many cut scans can wait for their orientations.
  static constexpr std::size_t kMaxWaiting = 4;

  explicit Pipeline(const PipelineOptions& options);

  // In order of arrival.
  void on_lidar(const ReturnBatch& batch) noexcept;
  void on_imu(const ImuSample& sample) noexcept;
  void on_encoder(const EncoderSample& sample) noexcept;
  // No more will come, or none for a while: the revolution at hand is closed. At the end of the
  // IMU, waiting scans no longer wait for orientations.
  void end_of_lidar() noexcept;
  void end_of_imu() noexcept { imu_ended_ = true; }
  void end_of_encoder() noexcept { encoder_ended_ = true; }

  // Levels the oldest scan into `out` if it is ready at `now`: its orientations are all there, or
  // will not come in time. False: none is ready.
  [[nodiscard]] bool level_next(HostTime now, LevelledScan& out) noexcept;
  // Labels what level_next() gave, by the chosen method.
  void cut(LevelledScan& scan) noexcept;
  // After cut(), once its labels are on their way: what they did not wait for. Whether there was
  // anything to learn.
  bool learn() noexcept;
  [[nodiscard]] bool learns_first() const noexcept { return options_.learn_first; }
  // All three.
  [[nodiscard]] bool next_scan(HostTime now, LevelledScan& out) noexcept {
    if (!level_next(now, out)) return false;
    cut(out);
    learn();
    return true;
  }

  // Of the scans that level_next() gives from now on.
  void set_effort(Effort effort) noexcept { effort_ = effort; }

  // Drops the oldest scans as long as they ended before `oldest_end`, or as the one behind is ready
  // as well; how many.
  std::size_t drop_superseded(HostTime now, HostTime oldest_end) noexcept;

  // The host's clock was set: nothing that is known of times holds any longer. The scan at hand and
  // those that wait are dropped (and counted), all mappings start anew.
  void restart_time() noexcept;

  // From the end of the newest scan given by level_next() to the expected end of the next; 0 when
  // it did not end with a cut, or the rotor's speed is not known.
  [[nodiscard]] Duration scan_period() const noexcept { return scan_period_; }

  // Scans that are cut but not yet ready.
  [[nodiscard]] std::size_t waiting() const noexcept { return waiting_count_; }

  // Host time of an instant of the lidar, as known now.
  [[nodiscard]] HostTime to_host(LidarTime t) const noexcept;
  [[nodiscard]] LidarTimeSource lidar_time_source() const noexcept;
  [[nodiscard]] ClockState lidar_clock() const noexcept { return lidar_clock_.state(); }
  [[nodiscard]] ClockState imu_clock() const noexcept { return imu_clock_.state(); }
  [[nodiscard]] const PacketSequencer& sequencer() const noexcept { return sequencer_; }
  [[nodiscard]] double rotor_hz() const noexcept { return rotor_hz_; }
  [[nodiscard]] std::uint64_t scans_cut() const noexcept { return scans_cut_; }
  // Scans that were dropped because too many waited, or the host's clock was set.
  [[nodiscard]] std::uint64_t scans_dropped() const noexcept { return scans_dropped_; }
  [[nodiscard]] std::uint64_t orientations_refused() const noexcept {
    return orientations_refused_;
  }
  [[nodiscard]] std::uint64_t orientations() const noexcept { return orientations_; }
  // Of those that level_next() gave, though there are poses.
  [[nodiscard]] std::uint64_t scans_without_position() const noexcept {
    return scans_without_position_;
  }
  [[nodiscard]] std::uint64_t stage_angles() const noexcept { return stage_angles_; }
  [[nodiscard]] std::uint64_t stage_angles_refused() const noexcept {
    return stage_angles_refused_;
  }

 private:
  // A scan's place in the host's time is fixed when it is cut: it depends on the lidar's packets up
  // to there alone, and not on how far the caller had come when the scan was ready.
  struct WaitingScan {
    Scan scan;
    HostTime stamp{};  // of its first firing

    [[nodiscard]] HostTime end() const noexcept {
      return stamp + (scan.last_firing - scan.first_firing);
    }
  };

  void wait_for_orientation(Scan& scan) noexcept;
  [[nodiscard]] bool ready(const WaitingScan& waiting, HostTime now) const noexcept;
  [[nodiscard]] Duration period_after(const Scan& scan) const noexcept;
  void pop_waiting() noexcept;
  void level_scan(const WaitingScan& waiting, LevelledScan& out) noexcept;
  // Lidar → level; none: missing at that time.
  [[nodiscard]] std::optional<Quaternion> lidar_orientation(HostTime time) const noexcept;

  PipelineOptions options_;
  HourClock hour_clock_;
  ClockMapping<LidarTime> lidar_clock_;
  ClockMapping<ImuTime> imu_clock_;
  PacketSequencer sequencer_;
  ScanCutter cutter_;
  OrientationTrack track_;
  OrientationTrack stage_track_;
  // One of the two.
  std::optional<ConvexCutEngine> engine_;
  std::optional<RobustCut> robust_;

  std::array<WaitingScan, kMaxWaiting> waiting_;  // a ring: first_waiting_ is the oldest
  std::size_t first_waiting_ = 0;
  std::size_t waiting_count_ = 0;

  Effort effort_ = Effort::full;
  std::uint32_t unlearnt_ = 0;  // scans since one was learnt from
  PpsState pps_ = PpsState::unknown;
  bool imu_ended_ = false;
  bool encoder_ended_ = false;
  std::uint32_t imu_clock_steps_ = 0;
  double rotor_hz_ = 0.0;
  Duration scan_period_{0};
  std::uint64_t scans_cut_ = 0;
  std::uint64_t scans_dropped_ = 0;
  std::uint64_t orientations_ = 0;
  std::uint64_t orientations_refused_ = 0;
  std::uint64_t scans_without_position_ = 0;
  std::uint64_t stage_angles_ = 0;
  std::uint64_t stage_angles_refused_ = 0;
};

}  // namespace convexcut::daemon
