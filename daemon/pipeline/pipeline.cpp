// SPDX-License-Identifier: Apache-2.0
#include "daemon/pipeline/pipeline.hpp"

#include <utility>

namespace convexcut::daemon {
namespace {

// A PPS-locked sensor counts UTC. When the host's clock is further than this from it (arrival delay
// included), IMU and lidar would no longer meet in one clock, so the envelope is used instead.
constexpr Duration kPpsAgreement = std::chrono::milliseconds{100};

// 2 s of a 400 Hz IMU: more than any scan spans and waits.
constexpr std::size_t kOrientations = 1024;
// 2 s of a stage that sends every millisecond.
constexpr std::size_t kStageAngles = 2048;

[[nodiscard]] bool reaches(const OrientationTrack& track, HostTime time) noexcept {
  const auto newest = track.newest();
  return newest && *newest >= time;
}

}  // namespace

Pipeline::Pipeline(const PipelineOptions& options)
    : options_(options),
      cutter_(options.cut, options.max_returns_per_scan, kMaxFiringsPerScan),
      track_(kOrientations, options.orientation_max_age),
      stage_track_(kStageAngles, options.stage_max_age) {
  if (options.method == config::Method::robust) {
    robust_.emplace(options.robust, options.max_returns_per_scan);
  } else {
    engine_.emplace(options.convex_cut, options.max_returns_per_scan, options.threads);
  }
  for (WaitingScan& waiting : waiting_) {
    reserve(waiting.scan, options.max_returns_per_scan, kMaxFiringsPerScan);
  }
}

void Pipeline::on_lidar(const ReturnBatch& batch) noexcept {
  pps_ = batch.pps;
  const LidarTime first_firing = hour_clock_.unwrap(batch.first_firing, batch.arrival);
  lidar_clock_.observe(first_firing, batch.arrival - batch.span());
  sequencer_.push(batch, first_firing, [this](const ReturnBatch& in_order, LidarTime t) {
    cutter_.push(in_order, t, [this](Scan& scan) { wait_for_orientation(scan); });
  });
}

void Pipeline::on_imu(const ImuSample& sample) noexcept {
  HostTime time = sample.arrival;
  if (sample.has_device_time) {
    imu_clock_.observe(sample.device_time, sample.arrival);
    time = imu_clock_.to_host(sample.device_time);
    if (const std::uint32_t steps = imu_clock_.state().steps; steps != imu_clock_steps_) {
      // The orientations so far were placed by a clock that has since been stepped.
      imu_clock_steps_ = steps;
      track_.clear();
    }
  }
  if (!sample.has_orientation) return;
  ++(track_.push(time, sample.q_level_from_imu) ? orientations_ : orientations_refused_);
}

void Pipeline::on_encoder(const EncoderSample& sample) noexcept {
  if (options_.stage_use == StageUse::none) return;
  // Stamps of one socket only go back when the host's clock has been set back.
  const auto newest = stage_track_.newest();
  if (newest && sample.arrival < *newest - options_.stage_max_age) stage_track_.clear();
  const Quaternion q_base_from_lidar = stage_rotation(options_.stage_axis, sample.angle);
  ++(stage_track_.push(sample.arrival, q_base_from_lidar) ? stage_angles_ : stage_angles_refused_);
}

void Pipeline::end_of_lidar() noexcept {
  const auto take = [this](Scan& scan) { wait_for_orientation(scan); };
  sequencer_.flush(
      [this, &take](const ReturnBatch& in_order, LidarTime t) { cutter_.push(in_order, t, take); });
  cutter_.finish(take);
}

void Pipeline::wait_for_orientation(Scan& scan) noexcept {
  ++scans_cut_;
  if (scan.rotor_hz > 0.0) rotor_hz_ = scan.rotor_hz;
  if (waiting_count_ == kMaxWaiting) {
    ++scans_dropped_;
    return;
  }
  WaitingScan& waiting = waiting_[(first_waiting_ + waiting_count_) % kMaxWaiting];
  std::swap(scan, waiting.scan);
  waiting.stamp = to_host(waiting.scan.first_firing);
  ++waiting_count_;
}

bool Pipeline::ready(const WaitingScan& waiting, HostTime now) const noexcept {
  const HostTime last = waiting.end();
  const bool imu_is_there = options_.fixed_mount || imu_ended_ || reaches(track_, last);
  const bool stage_is_there =
      options_.stage_use == StageUse::none || encoder_ended_ || reaches(stage_track_, last);
  return (imu_is_there && stage_is_there) || now >= last + options_.orientation_wait;
}

void Pipeline::level_scan(const WaitingScan& waiting, LevelledScan& out) noexcept {
  const auto& [scan, stamp] = waiting;
  if (options_.fixed_mount && options_.stage_use == StageUse::none) {
    level(scan, stamp, options_.q_level_from_lidar, out, firing_stride(effort_));
  } else {
    level(
        scan, stamp, [this](HostTime time) { return lidar_orientation(time); }, out,
        firing_stride(effort_));
  }
}

std::optional<Quaternion> Pipeline::lidar_orientation(HostTime time) const noexcept {
  Quaternion q_level_from_lidar = options_.q_level_from_lidar;
  if (!options_.fixed_mount) {
    const Orientation q_level_from_imu = track_.at(time);
    if (q_level_from_imu.quality == OrientationQuality::missing) return std::nullopt;
    q_level_from_lidar = q_level_from_imu.rotation * options_.q_imu_from_lidar;
  }
  if (options_.stage_use == StageUse::none) return q_level_from_lidar;
  const Orientation q_base_from_lidar = stage_track_.at(time);
  if (q_base_from_lidar.quality == OrientationQuality::missing) return std::nullopt;
  if (options_.stage_use == StageUse::heading) {
    return with_heading(q_level_from_lidar, q_base_from_lidar.rotation);
  }
  return q_level_from_lidar * q_base_from_lidar.rotation;
}

bool Pipeline::level_next(HostTime now, LevelledScan& out) noexcept {
  if (waiting_count_ == 0) return false;
  const WaitingScan& waiting = waiting_[first_waiting_];
  if (!ready(waiting, now)) return false;
  level_scan(waiting, out);
  if (options_.positions) {
    out.position_m = options_.positions->at(out.stamp);
    scans_without_position_ += out.position_m ? 0U : 1U;
  }
  scan_period_ = period_after(waiting.scan);
  pop_waiting();
  return true;
}

void Pipeline::cut(LevelledScan& scan) noexcept {
  // A levelled cloud is finite and within the engine's capacity, so this cannot be refused; were it
  // ever, every point would keep the label `other`.
  if (robust_) {
    const bool learn_first = options_.learn_first && effort_ == Effort::full;
    static_cast<void>(learn_first
                          ? robust_->label(scan.cloud(), scan.label, scan.position_m)
                          : robust_->label_at_once(scan.cloud(), scan.label, scan.position_m));
  } else {
    static_cast<void>(engine_->label(scan.cloud(), scan.label, plane_stride(effort_)));
  }
  scan.structure_points = 0;
  for (const Label label : scan.label) scan.structure_points += label == Label::structure ? 1U : 0U;
}

bool Pipeline::learn() noexcept {
  if (!robust_) return false;
  const bool is_time = ++unlearnt_ >= learning_stride(effort_);
  if (is_time) unlearnt_ = 0;
  return robust_->learn(is_time ? RobustCut::Learning::now : RobustCut::Learning::later);
}

std::size_t Pipeline::drop_superseded(HostTime now, HostTime oldest_end) noexcept {
  std::size_t dropped = 0;
  while (waiting_count_ > 0) {
    const bool too_old = waiting_[first_waiting_].end() < oldest_end;
    const bool newer_ready =
        waiting_count_ > 1 && ready(waiting_[(first_waiting_ + 1) % kMaxWaiting], now);
    if (!too_old && !newer_ready) break;
    pop_waiting();
    ++dropped;
  }
  return dropped;
}

void Pipeline::restart_time() noexcept {
  const auto drop = [this](Scan&) { ++scans_dropped_; };
  sequencer_.flush([](const ReturnBatch&, LidarTime) {});
  cutter_.finish(drop);
  scans_dropped_ += waiting_count_;
  waiting_count_ = first_waiting_ = 0;
  hour_clock_.reset();
  lidar_clock_.reset();
  imu_clock_.reset();
  imu_clock_steps_ = 0;
  track_.clear();
  stage_track_.clear();
  if (robust_) robust_->forget();
}

Duration Pipeline::period_after(const Scan& scan) const noexcept {
  if (scan.end != ScanEnd::cut) return Duration::zero();
  if (options_.cut.mode == CutOptions::Mode::clock) return options_.cut.window;
  if (scan.rotor_hz <= 0.0) return Duration::zero();
  return Duration{static_cast<Duration::rep>(1e9 / scan.rotor_hz)};
}

void Pipeline::pop_waiting() noexcept {
  first_waiting_ = (first_waiting_ + 1) % kMaxWaiting;
  // An empty queue starts over, so that the same few scans' memory stays in use.
  if (--waiting_count_ == 0) first_waiting_ = 0;
}

HostTime Pipeline::to_host(LidarTime t) const noexcept {
  if (lidar_time_source() == LidarTimeSource::pps) return HostTime{t.time_since_epoch()};
  return lidar_clock_.to_host(t);
}

LidarTimeSource Pipeline::lidar_time_source() const noexcept {
  const ClockState clock = lidar_clock_.state();
  if (clock.samples == 0) return LidarTimeSource::none;
  const bool agrees = clock.offset >= -kPpsAgreement && clock.offset <= kPpsAgreement;
  return pps_ == PpsState::locked && agrees ? LidarTimeSource::pps : LidarTimeSource::envelope;
}

}  // namespace convexcut::daemon
