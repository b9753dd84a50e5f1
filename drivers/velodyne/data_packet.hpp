// SPDX-License-Identifier: Apache-2.0
//
// The data packet as such, before any model is assumed: is it one, and does it report one or two
// echoes a pulse.
#pragma once

#include <cstdint>

#include "core/time.hpp"
#include "drivers/wire.hpp"

namespace convexcut::velodyne {

enum class DecodeStatus : std::uint8_t {
  ok,
  wrong_length,            // not 1206 bytes
  wrong_block_flag,        // a block that does not start FF EE: another product, or not Velodyne
  azimuth_out_of_range,    // above 360.00°
  timestamp_out_of_range,  // more than a second past the hour's end
};

// Everything that a packet can have wrong. The return mode and product bytes are no part of it: old
// firmware leaves them arbitrary.
[[nodiscard]] DecodeStatus check_data_packet(wire::Bytes payload) noexcept;

// The functions below take a payload that check_data_packet() has accepted.

// Whether blocks come in pairs, the last echo in the even and the strongest in the odd one. Says
// the return mode byte where it and the product byte are plausible; otherwise blocks with equal
// azimuths in all pairs do, provided that the rotor turns: at a standstill all azimuths are equal
// in every mode.
[[nodiscard]] bool has_dual_returns(wire::Bytes payload) noexcept;

// Reduced to 0 … 3 599 999 999.
[[nodiscard]] MicrosPastHour timestamp(wire::Bytes payload) noexcept;

[[nodiscard]] std::uint8_t product(wire::Bytes payload) noexcept;

// Of block 0 … 11 in 0.01°, 0 … 36000.
[[nodiscard]] std::uint16_t block_azimuth(wire::Bytes payload, std::size_t block) noexcept;

}  // namespace convexcut::velodyne
