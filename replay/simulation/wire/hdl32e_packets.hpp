// SPDX-License-Identifier: Apache-2.0
//
// The two datagrams of an HDL-32E, byte by byte. Layout: drivers/velodyne/wire_layout.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/angle.hpp"
#include "core/return_batch.hpp"
#include "core/time.hpp"
#include "drivers/velodyne/wire_layout.hpp"

namespace convexcut::simulation {

namespace layout = velodyne::wire_layout;

struct LaserReturn {
  std::uint16_t distance_2mm = 0;  // 0 = no return
  std::uint8_t intensity = 0;
};

struct DataBlock {
  Azimuth azimuth;
  std::array<LaserReturn, layout::kReturnsPerBlock> returns{};  // in firing order
};

struct DataPacket {
  MicrosPastHour first_firing;
  // Blocks come in pairs of one firing: the last echoes, then the strongest, or the second
  // strongest where the last is the strongest (wire facts: drivers/velodyne/decoder.hpp).
  bool dual = false;
  std::array<DataBlock, layout::kBlocks> blocks{};
};

struct PositionPacket {
  MicrosPastHour sent;
  HostTime utc{};  // goes into the GPRMC sentence, to the second
  PpsState pps = PpsState::absent;
};

using DataPacketBytes = std::array<std::byte, layout::kDataPacketSize>;
using PositionPacketBytes = std::array<std::byte, layout::kPositionPacketSize>;

// Return mode strongest, or dual. The azimuth is rounded to 0.01°, and as in real sensors to 36000
// rather than 0 just before north.
[[nodiscard]] DataPacketBytes encode(const DataPacket& packet);

// GPRMC says "valid" when PPS is locked. The motion sensors read an upright housing at rest, 25 °C.
[[nodiscard]] PositionPacketBytes encode(const PositionPacket& packet);

}  // namespace convexcut::simulation
