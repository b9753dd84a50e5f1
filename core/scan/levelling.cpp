// SPDX-License-Identifier: Apache-2.0
#include "core/scan/levelling.hpp"

#include <algorithm>
#include <cstdint>

namespace convexcut {
namespace {

using Rotation = Eigen::Matrix3f;

// Writes the points of `scan` behind each other into `levelled`, which has been given their number.
class Writer {
 public:
  Writer(const Scan& scan, LevelledScan& levelled) noexcept : scan_(scan), levelled_(levelled) {
    capacity_ =
        std::min({scan.size(), levelled.x.capacity(), levelled.y.capacity(), levelled.z.capacity(),
                  levelled.intensity.capacity(), levelled.ring.capacity(),
                  levelled.time_ns.capacity(), levelled.label.capacity()});
    resize(capacity_);
  }

  void write(std::size_t first, std::size_t count, const Rotation& r_level_from_lidar) noexcept {
    const std::size_t fitting = std::min(count, capacity_ - written_);
    levelled_.overflow_returns += static_cast<std::uint32_t>(count - fitting);
    rotate(first, fitting, r_level_from_lidar);
    copy(scan_.intensity, first, fitting, levelled_.intensity);
    copy(scan_.ring, first, fitting, levelled_.ring);
    copy(scan_.time_ns, first, fitting, levelled_.time_ns);
    written_ += fitting;
  }

  void finish() noexcept {
    resize(written_);
    std::fill(levelled_.label.begin(), levelled_.label.end(), Label::other);
  }

 private:
  void rotate(std::size_t first, std::size_t count, const Rotation& r) noexcept {
    // The arrays of two scans never overlap; saying so lets the loop be vectorised.
    const float* __restrict x_lidar = scan_.x_lidar.data() + first;
    const float* __restrict y_lidar = scan_.y_lidar.data() + first;
    const float* __restrict z_lidar = scan_.z_lidar.data() + first;
    float* __restrict x = levelled_.x.data() + written_;
    float* __restrict y = levelled_.y.data() + written_;
    float* __restrict z = levelled_.z.data() + written_;
    const float xx = r(0, 0), xy = r(0, 1), xz = r(0, 2);
    const float yx = r(1, 0), yy = r(1, 1), yz = r(1, 2);
    const float zx = r(2, 0), zy = r(2, 1), zz = r(2, 2);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = xx * x_lidar[i] + xy * y_lidar[i] + xz * z_lidar[i];
      y[i] = yx * x_lidar[i] + yy * y_lidar[i] + yz * z_lidar[i];
      z[i] = zx * x_lidar[i] + zy * y_lidar[i] + zz * z_lidar[i];
    }
  }

  template <class Column>
  void copy(const Column& from, std::size_t first, std::size_t count, Column& to) const noexcept {
    std::copy_n(from.data() + first, count, to.data() + written_);
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
  std::size_t capacity_ = 0;
  std::size_t written_ = 0;
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
}

Rotation to_matrix(const Quaternion& q) noexcept { return q.toRotationMatrix().cast<float>(); }

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
