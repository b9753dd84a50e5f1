// SPDX-License-Identifier: Apache-2.0
//
// The loops over the 32 returns of a block, written once and compiled for every instruction set
// (Highway, chosen when first called). Products and sums are rounded one by one, in double, on
// every path: all give the same bits. RT: no allocation, no lock, no system call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/return_batch.hpp"
#include "drivers/velodyne/wire_layout.hpp"
#include "drivers/wire.hpp"

namespace convexcut::velodyne {

// What is constant of each of the 32 returns of a block, by place in the block.
struct SlotTable {
  template <class T>
  using Column = std::array<T, wire_layout::kReturnsPerBlock>;

  // Of the block period that passes before it fires; a multiple of 2⁻³².
  alignas(64) Column<double> block_share{};
  alignas(64) Column<double> azimuth_offset_udeg{};  // whole
  alignas(64) Column<double> cos_elevation{};
  alignas(64) Column<double> sin_elevation{};
  alignas(64) Column<double> vertical_offset_m{};
  alignas(64) Column<std::uint32_t> time_ns{};  // after the block's first laser
  alignas(64) Column<std::uint32_t> ring{};
  double metres_per_tick = 0.0;
};

// The returns of one block, in the order of the block, also those without an echo.
struct BlockReturns {
  template <class T>
  using Column = SlotTable::Column<T>;

  alignas(64) Column<float> x_lidar, y_lidar, z_lidar, range_m;
  alignas(64) Column<std::uint16_t> ticks;  // 0: no echo
  alignas(64) Column<std::uint8_t> intensity;
};

// Where the rotor is during a block: whole microdegrees.
struct BlockSweep {
  double azimuth_udeg = 0.0;  // of the block's first laser, 0 … 360e6
  double step_udeg = 0.0;     // in a block period, less than 10° either way
};

// Positions of the 32 returns of `block`, wire_layout::kBlockSize bytes.
void locate(const SlotTable& slots, const BlockSweep& sweep, wire::Bytes block,
            BlockReturns& out) noexcept;

// Appends the returns with an echo to the columns of `batch` but `echo` and `farthest`, and counts
// them in it. start_ns: of the block, after the datagram's first firing. Returns which of the 32
// these were, the first in the lowest bit. The batch has room for all 32.
std::uint32_t append_echoes(const SlotTable& slots, const BlockReturns& block,
                            std::uint32_t start_ns, ReturnBatch& batch) noexcept;

}  // namespace convexcut::velodyne
