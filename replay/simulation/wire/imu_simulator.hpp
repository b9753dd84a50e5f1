// SPDX-License-Identifier: Apache-2.0
//
// The IMU of the rig: the same motion over a serial line (MTi, MTData2) and over CAN (MTi-600).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/time.hpp"
#include "replay/simulation/random.hpp"
#include "replay/simulation/rig/rig_state.hpp"
#include "replay/simulation/wire/device_clock.hpp"
#include "replay/simulation/wire/serial_line.hpp"

namespace convexcut::simulation {

// When samples are taken: from then on, for so long. `from` counts from the start of the simulation
// and may lie before it.
struct Period {
  Duration from{};
  Duration length{};
};

struct ImuNoise {  // standard deviations; the orientation is the truth
  double rate_of_turn_rad_s = 0.003;
  double acceleration_m_s2 = 0.02;
};

struct SerialImuOptions {
  std::int64_t rate_hz = 100;  // that divides 400
  std::uint32_t baud = 115200;
  Duration jitter{0};  // up to so much longer than usual from sampling to sending
  DeviceClock clock{.fast_by_ppm = 20.0};
  ImuNoise noise{};
};

// PacketCounter, SampleTimeFine, Quaternion, Acceleration, RateOfTurn, StatusWord: bytes.
inline constexpr std::size_t kSerialFrameSize = 73;
// What the line can carry.
[[nodiscard]] constexpr std::int64_t max_rate_hz(std::uint32_t baud) noexcept {
  return std::int64_t{baud} / static_cast<std::int64_t>(kSerialFrameSize * 10);
}

// `start` is the host's time at the start of the simulation.
void send_samples(const SerialImuOptions& options, RigStateAt motion, HostTime start,
                  const Period& period, Random& random, SerialLine& line);

struct CanImuOptions {
  std::int64_t rate_hz = 100;
  std::uint32_t bitrate = 250000;
  DeviceClock clock{.fast_by_ppm = -15.0};
  ImuNoise noise{};
};

// The frames of the same motion as lines of `candump -L`: SampleTime, GroupCounter, Quaternion,
// RateOfTurn and Acceleration, with the default identifiers.
[[nodiscard]] std::string candump_log(const CanImuOptions& options, RigStateAt motion,
                                      HostTime start, const Period& period, Random& random);

}  // namespace convexcut::simulation
