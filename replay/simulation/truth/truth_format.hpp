// SPDX-License-Identifier: Apache-2.0
//
// The folder `truth` of a simulated recording:
//   simulation.toml  what was simulated, and the names and labels of the scene's surfaces
//   returns.bin      every firing with the truth of each of its returns
//   poses.csv        where the lidar was: stamp_ns,x,y,z,qx,qy,qz,qw (of lidar in world), 400 Hz
//
// Layout of returns.bin, all numbers little-endian: a header, then one record a firing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/time.hpp"
#include "drivers/recording/pose_file.hpp"

namespace convexcut::simulation::truth_format {

inline constexpr int kVersion = 1;

inline constexpr std::string_view kSettingsFile = "simulation.toml";
inline constexpr std::string_view kReturnsFile = "returns.bin";
inline constexpr std::string_view kPosesFile = "poses.csv";
inline constexpr std::string_view kPosesHeader = recording::kPoseFileHeader;
inline constexpr Duration kPosePeriod = std::chrono::microseconds{2500};

// --- header
inline constexpr std::string_view kMagic = "CVXTRUTH";
inline constexpr std::size_t kMagicOffset = 0;
inline constexpr std::size_t kVersionOffset = 8;      // u32
inline constexpr std::size_t kHeaderSizeOffset = 12;  // u32
inline constexpr std::size_t kRecordSizeOffset = 16;  // u32
inline constexpr std::size_t kEchoesOffset = 20;      // u16, 1 or 2
inline constexpr std::size_t kLasersOffset = 22;      // u16
inline constexpr std::size_t kFiringsOffset = 24;     // u64
inline constexpr std::size_t kHeaderSize = 32;
static_assert(kMagic.size() == kVersionOffset);
static_assert(kFiringsOffset + sizeof(std::uint64_t) == kHeaderSize);

// --- record: time and azimuth, then the returns, all lasers of the first echo before the second's
inline constexpr std::size_t kTimeOffset = 0;     // i64, host time of the first laser, ns
inline constexpr std::size_t kAzimuthOffset = 8;  // u16, 0.01°, as on the wire
inline constexpr std::size_t kReturnsOffset = 16;
inline constexpr std::size_t kReturnSize = 10;
inline constexpr std::size_t kRangeOffset = 0;      // u16, 2 mm, as on the wire; 0 = no return
inline constexpr std::size_t kTrueRangeOffset = 2;  // f32, m, without noise and rounding
inline constexpr std::size_t kLabelOffset = 6;      // u8, SurfaceLabel
inline constexpr std::size_t kFlagsOffset = 7;      // u8, as in simulated_firing.hpp
inline constexpr std::size_t kSurfaceOffset = 8;    // u16, 0xFFFF = none
static_assert(kSurfaceOffset + sizeof(std::uint16_t) == kReturnSize);

inline constexpr std::size_t kLasers = 32;
[[nodiscard]] constexpr std::size_t record_size(std::size_t echoes) noexcept {
  return kReturnsOffset + echoes * kLasers * kReturnSize;
}

}  // namespace convexcut::simulation::truth_format
