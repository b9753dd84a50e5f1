// SPDX-License-Identifier: Apache-2.0
//
// Where things are in the two datagrams of the HDL-32E family; all numbers are little-endian.
// Sources: HDL-32E User's Manual 63-9113 (data packet p. 19-21, position packet p. 21 and figure
// B2), VLP-16 User Manual 63-9243, and the PPS field as VeloView reads it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace convexcut::velodyne::wire_layout {

inline constexpr std::uint16_t kDataPort = 2368;
inline constexpr std::uint16_t kPositionPort = 8308;

// --- data packet: 12 blocks, then timestamp, return mode and product
inline constexpr std::size_t kDataPacketSize = 1206;
inline constexpr std::size_t kBlocks = 12;
inline constexpr std::size_t kBlockSize = 100;
inline constexpr std::size_t kBlockFlag = 0;     // u16, within a block
inline constexpr std::size_t kBlockAzimuth = 2;  // u16, 0.01°, 0 … 36000 inclusive
inline constexpr std::size_t kBlockReturns = 4;  // 32 × 3 bytes
inline constexpr std::size_t kReturnsPerBlock = 32;
inline constexpr std::size_t kReturnSize = 3;
inline constexpr std::size_t kReturnDistance = 0;    // u16, in the model's unit; 0 = no return
inline constexpr std::size_t kReturnIntensity = 2;   // u8
inline constexpr std::size_t kDataTimestamp = 1200;  // u32, µs past the hour
inline constexpr std::size_t kReturnMode = 1204;     // u8
inline constexpr std::size_t kProduct = 1205;        // u8

inline constexpr std::uint16_t kUpperBankFlag = 0xEEFF;  // FF EE on the wire; others: HDL-64, VLS
inline constexpr std::uint16_t kMaxAzimuth = 36000;      // occurs in real data and means 0
inline constexpr std::uint8_t kModeStrongest = 0x37;
inline constexpr std::uint8_t kModeLast = 0x38;
inline constexpr std::uint8_t kModeDual = 0x39;

static_assert(kBlockReturns + kReturnsPerBlock * kReturnSize == kBlockSize);
static_assert(kBlocks * kBlockSize == kDataTimestamp);
static_assert(kDataTimestamp + sizeof(std::uint32_t) == kReturnMode);
static_assert(kProduct + 1 == kDataPacketSize);

// --- position packet: three motion sensors, timestamp, PPS state, NMEA sentence
inline constexpr std::size_t kPositionPacketSize = 512;
inline constexpr std::size_t kMotion = 14;  // three sets of four u16
inline constexpr std::size_t kMotionSets = 3;
inline constexpr std::size_t kMotionSetSize = 8;
inline constexpr std::size_t kMotionGyro = 0;  // within a set
inline constexpr std::size_t kMotionTemperature = 2;
inline constexpr std::size_t kMotionAccelX = 4;
inline constexpr std::size_t kMotionAccelY = 6;
inline constexpr std::size_t kPositionTimestamp = 198;  // u32, µs past the hour
inline constexpr std::size_t kPpsState = 202;           // u8
inline constexpr std::size_t kNmea = 206;               // ASCII, CR LF, padded with NUL
inline constexpr std::size_t kNmeaSize = kPositionPacketSize - kNmea;

static_assert(kMotion + kMotionSets * kMotionSetSize == 38);
static_assert(kPositionTimestamp + sizeof(std::uint32_t) == kPpsState);
static_assert(kNmeaSize == 306);

// --- both: the counter wraps at the top of the hour
inline constexpr std::uint32_t kMicrosPerHour = 3'600'000'000;
// A counter that waits for a late top-of-hour pulse runs past the hour: up to a second is taken for
// that, more for garbage.
inline constexpr std::uint32_t kMaxTimestamp = kMicrosPerHour + 1'000'000;

}  // namespace convexcut::velodyne::wire_layout
