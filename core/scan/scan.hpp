// SPDX-License-Identifier: Apache-2.0
//
// One scan before and after levelling. Both are structures of arrays with a capacity that is set
// once: filling them allocates nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/cloud.hpp"
#include "core/geometry.hpp"
#include "core/time.hpp"

namespace convexcut {

enum class ScanEnd : std::uint8_t {
  cut,           // the cut azimuth (or the end of the clock window) was passed
  timeout,       // no cut came in time: the rotor stands still or turns too slowly
  end_of_input,  // the recording ended, or the source went away
  no_data,       // no scan at all: the worker's empty result when the sensor is silent
};

// A firing of a scan: its returns are [first_return, first_return + return_count) of the scan.
struct ScanFiring {
  LidarTime time;
  std::uint32_t first_return = 0;
  std::uint32_t return_count = 0;
};

// What the cutter fills: the selected returns of one revolution, frame lidar, in firing order.
struct Scan {
  std::uint64_t index = 0;  // counts scans from 0
  ScanEnd end = ScanEnd::cut;
  LidarTime first_firing{};
  LidarTime last_firing{};  // start of the last firing
  std::uint32_t expected_firings =
      0;                  // that a whole revolution (or window) has at this rotor speed
  double rotor_hz = 0.0;  // 0 when unknown
  std::uint32_t overflow_returns = 0;  // beyond the capacity: dropped and counted

  std::vector<ScanFiring> firings;
  std::vector<float> x_lidar, y_lidar, z_lidar;  // metres
  std::vector<std::uint8_t> intensity;
  std::vector<std::uint8_t> ring;
  std::vector<std::uint32_t> time_ns;  // after first_firing, of the return's own laser

  [[nodiscard]] std::size_t size() const noexcept { return x_lidar.size(); }
  // Share of the expected firings that were seen, 0 … 1.
  [[nodiscard]] double coverage() const noexcept {
    if (expected_firings == 0) return 0.0;
    const double share = static_cast<double>(firings.size()) / expected_firings;
    return share < 1.0 ? share : 1.0;
  }
};

// What leaves the pipeline: the scan in frame level with its labels. The stamp is the first firing
// of the scan in host time; point times are offsets ≥ 0 from it.
struct LevelledScan {
  std::uint64_t index = 0;
  ScanEnd end = ScanEnd::cut;
  HostTime stamp{};
  HostTime last_firing{};
  LidarTime first_firing{};  // the stamp on the sensor's own clock
  double coverage = 0.0;
  std::uint32_t dropped_no_orientation = 0;  // points without an orientation at their firing time
  std::uint32_t overflow_returns = 0;
  std::uint32_t structure_points = 0;
  // Of the lidar at the stamp, where poses are known: metres, in a frame that stands still and has
  // the axes of level.
  std::optional<Vec3> position_m;

  std::vector<float> x, y, z;  // frame level, metres
  std::vector<std::uint8_t> intensity;
  std::vector<std::uint8_t> ring;
  std::vector<std::uint32_t> time_ns;  // after stamp
  std::vector<Label> label;

  [[nodiscard]] std::size_t size() const noexcept { return x.size(); }
  [[nodiscard]] CloudView cloud() const noexcept { return {x, y, z}; }

  // Empty, with the capacity that it had.
  void clear() noexcept {
    index = 0;
    end = ScanEnd::cut;
    stamp = last_firing = {};
    first_firing = {};
    coverage = 0.0;
    dropped_no_orientation = overflow_returns = structure_points = 0;
    position_m.reset();
    x.clear();
    y.clear();
    z.clear();
    intensity.clear();
    ring.clear();
    time_ns.clear();
    label.clear();
  }
};

}  // namespace convexcut
