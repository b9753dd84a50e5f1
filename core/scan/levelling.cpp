// SPDX-License-Identifier: Apache-2.0
#include "core/scan/levelling.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/scan/rotation_kernel.hpp"

namespace convexcut {
namespace {

// Writes the points of `scan` behind each other into `levelled`, which has been given their number.
class Writer {
 public:
  Writer(const Scan& scan, LevelledScan& levelled) noexcept
      : scan_(scan),
        levelled_(levelled),
        capacity_(std::min({scan.size(), levelled.x.capacity(), levelled.y.capacity(),
                            levelled.z.capacity(), levelled.intensity.capacity(),
                            levelled.ring.capacity(), levelled.time_ns.capacity(),
                            levelled.label.capacity()})) {
    resize(capacity_);
  }

  void write(std::size_t first, std::size_t count, const Rotation& r_level_from_lidar) noexcept {
    const std::size_t fitting = std::min(count, capacity_ - written_);
    levelled_.overflow_returns += static_cast<std::uint32_t>(count - fitting);
    if (run_count_ == runs_.size()) rotate_runs();
    runs_[run_count_++] = {first, written_, fitting, r_level_from_lidar};
    if (first != copy_end_) copy_columns();
    if (copy_begin_ == copy_end_) copy_begin_ = copy_end_ = first;
    copy_end_ += fitting;
    written_ += fitting;
  }

  void finish() noexcept {
    rotate_runs();
    copy_columns();
    resize(written_);
    std::fill(levelled_.label.begin(), levelled_.label.end(), Label::other);
  }

 private:
  void rotate_runs() noexcept {
    rotate(std::span(runs_).first(run_count_), {scan_.x_lidar, scan_.y_lidar, scan_.z_lidar},
           {levelled_.x, levelled_.y, levelled_.z});
    run_count_ = 0;
  }

  // Of the points [copy_begin_, copy_end_) of the scan, the last that were written.
  void copy_columns() noexcept {
    const std::size_t count = copy_end_ - copy_begin_;
    const auto copy = [&](const auto& from, auto& to) noexcept {
      std::copy_n(from.data() + copy_begin_, count, to.data() + (written_ - count));
    };
    copy(scan_.intensity, levelled_.intensity);
    copy(scan_.ring, levelled_.ring);
    copy(scan_.time_ns, levelled_.time_ns);
    copy_begin_ = copy_end_;
  }

  void resize(std::size_t size) noexcept {
    levelled_.x.resize(size);
    levelled_.y.resize(size);
    levelled_.z.resize(size);
    levelled_.intensity.resize(size);
    levelled_.ring.resize(size);
    levelled_.time_ns.resize(size);
    levelled_.label.resize(size);
  }

  const Scan& scan_;
  LevelledScan& levelled_;
  std::size_t capacity_;
  std::size_t written_ = 0;
  // Firings mostly follow each other without a gap: the other columns are copied in few runs.
  std::size_t copy_begin_ = 0;
  std::size_t copy_end_ = 0;
  std::array<RotatedRun, 64> runs_;
  std::size_t run_count_ = 0;
};

void copy_header(const Scan& scan, HostTime stamp, LevelledScan& levelled) noexcept {
  levelled.index = scan.index;
  levelled.end = scan.end;
  levelled.stamp = stamp;
  levelled.last_firing = stamp + (scan.last_firing - scan.first_firing);
  levelled.first_firing = scan.first_firing;
  levelled.coverage = scan.coverage();
  levelled.dropped_no_orientation = 0;
  levelled.overflow_returns = scan.overflow_returns;
  levelled.structure_points = 0;
  levelled.position_m.reset();
}

Rotation to_matrix(const Quaternion& q) noexcept {
  const Eigen::Matrix3f r = q.toRotationMatrix().cast<float>();
  return {r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)};
}

}  // namespace

void reserve(LevelledScan& scan, std::size_t max_points) {
  scan.x.reserve(max_points);
  scan.y.reserve(max_points);
  scan.z.reserve(max_points);
  scan.intensity.reserve(max_points);
  scan.ring.reserve(max_points);
  scan.time_ns.reserve(max_points);
  scan.label.reserve(max_points);
}

void level(const Scan& scan, HostTime stamp, LidarOrientationAt q_level_from_lidar,
           LevelledScan& levelled, std::size_t firing_stride) noexcept {
  copy_header(scan, stamp, levelled);
  Writer points(scan, levelled);
  for (std::size_t i = 0; i < scan.firings.size(); i += firing_stride) {
    const ScanFiring& firing = scan.firings[i];
    if (firing.return_count == 0) continue;
    const auto rotation = q_level_from_lidar(stamp + (firing.time - scan.first_firing));
    if (!rotation) {
      levelled.dropped_no_orientation += firing.return_count;
      continue;
    }
    points.write(firing.first_return, firing.return_count, to_matrix(*rotation));
  }
  points.finish();
}

void level(const Scan& scan, HostTime stamp, const OrientationTrack& orientations,
           const Quaternion& q_imu_from_lidar, LevelledScan& levelled,
           std::size_t firing_stride) noexcept {
  const auto q_level_from_lidar = [&](HostTime time) -> std::optional<Quaternion> {
    const Orientation q_level_from_imu = orientations.at(time);
    if (q_level_from_imu.quality == OrientationQuality::missing) return std::nullopt;
    return q_level_from_imu.rotation * q_imu_from_lidar;
  };
  level(scan, stamp, q_level_from_lidar, levelled, firing_stride);
}

void level(const Scan& scan, HostTime stamp, const Quaternion& q_level_from_lidar,
           LevelledScan& levelled, std::size_t firing_stride) noexcept {
  copy_header(scan, stamp, levelled);
  Writer points(scan, levelled);
  const Rotation r_level_from_lidar = to_matrix(q_level_from_lidar);
  if (firing_stride == 1) {
    points.write(0, scan.size(), r_level_from_lidar);
  } else {
    for (std::size_t i = 0; i < scan.firings.size(); i += firing_stride) {
      points.write(scan.firings[i].first_return, scan.firings[i].return_count, r_level_from_lidar);
    }
  }
  points.finish();
}

}  // namespace convexcut
