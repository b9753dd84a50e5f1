// SPDX-License-Identifier: Apache-2.0
//
// Datagrams of an ideal HDL-32E whose every firing is known: firing k has the azimuth azimuth(k),
// and all its returns have x = k and y = their ring.
#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "core/return_batch.hpp"
#include "core/scan/scan.hpp"
#include "core/time.hpp"

namespace convexcut::test {

inline constexpr std::uint32_t kFiringPeriodNs = 46'080;
inline constexpr std::uint32_t kLaserPeriodNs = 1'152;
inline constexpr std::int64_t kFiringsPerPacket = 12;
inline constexpr LidarTime kFirstPacket{std::chrono::hours{1}};

struct TimedBatch {
  ReturnBatch batch;
  LidarTime first_firing{};
};

// Adds a firing of `count` returns to a batch; all of them valid, single returns, 10 m away.
inline void add_firing(ReturnBatch& batch, Azimuth azimuth, std::size_t count,
                       std::int64_t number) {
  Firing& firing = batch.firings[batch.firing_count];
  firing.azimuth = azimuth;
  firing.offset_ns = kFiringPeriodNs * batch.firing_count;
  firing.first_return = batch.return_count;
  firing.return_count = static_cast<std::uint16_t>(count);
  for (std::size_t ring = 0; ring < count; ++ring) {
    const std::size_t i = batch.return_count++;
    batch.x_lidar[i] = static_cast<float>(number);
    batch.y_lidar[i] = static_cast<float>(ring);
    batch.z_lidar[i] = 0.0F;
    batch.range_m[i] = 10.0F;
    batch.offset_ns[i] = firing.offset_ns + kLaserPeriodNs * static_cast<std::uint32_t>(ring);
    batch.intensity[i] = static_cast<std::uint8_t>(number % 256);
    batch.ring[i] = static_cast<std::uint8_t>(ring);
    batch.echo[i] = Echo::only;
    batch.farthest[i] = true;
  }
  ++batch.firing_count;
}

class SyntheticLidar {
 public:
  double rate_hz = 10.0;
  double start_degrees = 0.0;
  double sway_degrees = 0.0;  // by which a rotor that hunts at 1 Hz leads and lags
  LidarTime start = kFirstPacket;
  std::size_t returns_per_firing = 32;
  // Centidegrees that the encoder is off at a firing.
  std::function<std::int64_t(std::int64_t)> encoder_error = [](std::int64_t) { return 0; };

  // 0.01°, not reduced to a turn.
  [[nodiscard]] std::int64_t centidegrees(std::int64_t firing) const {
    const double t = static_cast<double>(firing) * kFiringPeriodNs * 1e-9;
    const double sway = sway_degrees * std::sin(2.0 * std::numbers::pi * t);
    const double degrees = start_degrees + 360.0 * rate_hz * t + sway;
    return static_cast<std::int64_t>(std::floor(degrees * 100.0)) + encoder_error(firing);
  }
  [[nodiscard]] Azimuth azimuth(std::int64_t firing) const {
    return Azimuth::from_centidegrees(centidegrees(firing));
  }
  // Of the datagram, in the sensor's whole microseconds.
  [[nodiscard]] LidarTime time(std::int64_t packet) const {
    const Duration elapsed{packet * kFiringsPerPacket * kFiringPeriodNs};
    return start + std::chrono::floor<std::chrono::microseconds>(elapsed);
  }
  [[nodiscard]] TimedBatch packet(std::int64_t number) const {
    TimedBatch timed;
    timed.first_firing = time(number);
    timed.batch.firing_period_ns = kFiringPeriodNs;
    for (std::int64_t i = 0; i < kFiringsPerPacket; ++i) {
      const std::int64_t firing = number * kFiringsPerPacket + i;
      add_firing(timed.batch, azimuth(firing), returns_per_firing, firing);
    }
    return timed;
  }
  [[nodiscard]] static std::int64_t packets_in(Duration span) {
    return span.count() / (kFiringsPerPacket * kFiringPeriodNs);
  }
};

// A datagram of firings at the stated azimuths (0.01°), each with `returns` returns numbered from
// `first_number`.
[[nodiscard]] inline TimedBatch packet_of(const std::vector<std::int64_t>& centidegrees,
                                          LidarTime first_firing, std::size_t returns = 1,
                                          std::int64_t first_number = 0) {
  TimedBatch timed;
  timed.first_firing = first_firing;
  timed.batch.firing_period_ns = kFiringPeriodNs;
  for (const std::int64_t azimuth : centidegrees) {
    add_firing(timed.batch, Azimuth::from_centidegrees(azimuth), returns, first_number++);
  }
  return timed;
}

// The numbers of the firings of a scan, one a firing that has returns.
[[nodiscard]] inline std::vector<std::int64_t> firing_numbers(const Scan& scan) {
  std::vector<std::int64_t> numbers;
  for (const ScanFiring& firing : scan.firings) {
    if (firing.return_count == 0) continue;
    numbers.push_back(static_cast<std::int64_t>(scan.x_lidar[firing.first_return]));
  }
  return numbers;
}

}  // namespace convexcut::test
