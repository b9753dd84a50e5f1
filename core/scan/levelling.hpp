// SPDX-License-Identifier: Apache-2.0
//
// From a scan in the lidar's frame to one in frame level.
#pragma once

#include <cstddef>
#include <optional>

#include "core/geometry.hpp"
#include "core/scan/function_ref.hpp"
#include "core/scan/orientation_track.hpp"
#include "core/scan/scan.hpp"
#include "core/time.hpp"

namespace convexcut {

// Gives `scan` the capacity that level() fills.
void reserve(LevelledScan& scan, std::size_t max_points);

// What the functions below do: fill `levelled`, whose labels are all Label::other afterwards, with
// the points of `scan` in its order. `stamp` is the host's time of scan.first_firing; the other
// firings follow by the sensor's clock, whose skew makes nothing of a scan's 0.1 s (200 ppm: 20
// µs). Points beyond the capacity of `levelled` are dropped and counted in its overflow_returns.
// firing_stride ≥ 1: only every firing_stride-th firing is taken. RT: no allocation, no lock, no
// system call.

// Each firing by the orientation at its own time, which takes the rotation during the scan out of
// it: p_level = q_level_from_imu(t) · q_imu_from_lidar · p_lidar. All lasers of a firing (36 µs of
// an HDL-32E) share it: at 300 °/s that is 0.01°. Points of firings whose orientation is missing
// are dropped and counted in dropped_no_orientation.
void level(const Scan& scan, HostTime stamp, const OrientationTrack& orientations,
           const Quaternion& q_imu_from_lidar, LevelledScan& levelled,
           std::size_t firing_stride = 1) noexcept;

// As above, by any other knowledge of the orientation: none where it is missing. Called once for
// each firing that has returns, in the order of time.
using LidarOrientationAt = FunctionRef<std::optional<Quaternion>(HostTime)>;
void level(const Scan& scan, HostTime stamp, LidarOrientationAt q_level_from_lidar,
           LevelledScan& levelled, std::size_t firing_stride = 1) noexcept;

// All firings by one orientation, that of a fixed mount.
void level(const Scan& scan, HostTime stamp, const Quaternion& q_level_from_lidar,
           LevelledScan& levelled, std::size_t firing_stride = 1) noexcept;

}  // namespace convexcut
