// SPDX-License-Identifier: Apache-2.0
//
// What a lidar driver makes of one datagram: the returns as a structure of arrays, in firing order,
// and the firings that they belong to. Fixed size, filled in place in a ring slot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/angle.hpp"
#include "core/time.hpp"

namespace convexcut {

// The pulse-per-second state that the sensor last reported in a position packet (offset 202).
enum class PpsState : std::uint8_t {
  absent = 0,
  synchronising = 1,
  locked = 2,
  error = 3,
  unknown = 255
};

// Which echo of its laser pulse a return is.
enum class Echo : std::uint8_t {
  only = 0,       // single-return mode, or a dual-return firing whose echoes coincide
  last = 1,       // the last of two
  strongest = 2,  // the strongest of two (the second strongest where the last is the strongest)
};

// One firing: all lasers of the sensor fired once, in order (HDL-32E: one block of 32; VLP-16: half
// a block). The unit in which scans are cut.
struct Firing {
  Azimuth azimuth;                 // of its first laser
  std::uint32_t offset_ns = 0;     // of its first laser, after the datagram's first firing
  std::uint16_t first_return = 0;  // its returns are [first_return, first_return + return_count)
  std::uint16_t return_count = 0;
};

struct ReturnBatch {
  static constexpr std::size_t kMaxReturns = 384;  // 12 blocks × 32, for every model
  static constexpr std::size_t kMaxFirings = 24;   // VLP-16: two firings a block

  HostTime arrival{};             // kernel or capture stamp of the datagram
  MicrosPastHour first_firing{};  // the sensor's time of the first firing
  PpsState pps = PpsState::unknown;
  std::uint32_t firing_period_ns = 0;  // 46 080 for the HDL-32E
  std::uint16_t firing_count = 0;
  std::uint16_t return_count = 0;

  std::array<Firing, kMaxFirings> firings;
  // Valid returns only (range ≠ 0 on the wire), frame lidar (REP-103), metres.
  alignas(64) std::array<float, kMaxReturns> x_lidar;
  alignas(64) std::array<float, kMaxReturns> y_lidar;
  alignas(64) std::array<float, kMaxReturns> z_lidar;
  alignas(64) std::array<float, kMaxReturns> range_m;
  std::array<std::uint32_t, kMaxReturns>
      offset_ns;  // of the return's laser, after the first firing
  std::array<std::uint8_t, kMaxReturns> intensity;
  std::array<std::uint8_t, kMaxReturns> ring;  // 0 = lowest beam
  std::array<Echo, kMaxReturns> echo;
  std::array<bool, kMaxReturns> farthest;  // no farther return of the same laser pulse

  // The time the datagram covers: firing_count firings. A datagram cannot arrive before it has
  // passed.
  [[nodiscard]] Duration span() const noexcept {
    return Duration{static_cast<Duration::rep>(firing_period_ns) * firing_count};
  }
};

}  // namespace convexcut
