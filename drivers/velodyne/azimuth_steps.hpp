// SPDX-License-Identifier: Apache-2.0
//
// How far the rotor turns from one block of a data packet to the next: what the azimuths of single
// lasers are interpolated with.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/velodyne/wire_layout.hpp"

namespace convexcut::velodyne {

// One a block, 0.01°, positive clockwise.
using AzimuthSteps = std::array<std::int32_t, wire_layout::kBlocks>;

// `azimuths`: of the packet's 12 blocks, or 6 block pairs; 0.01°, 0 … 36000. A step is the
// difference to the next block; the last block repeats the one before it. Nothing can be lost
// within a packet, so a step far from the packet's median is a glitch of the encoder and the median
// takes its place. When the median itself is above `max_step`, either way round, the azimuths say
// nothing about the rotor and all steps are 0.
[[nodiscard]] AzimuthSteps azimuth_steps(std::span<const std::uint16_t> azimuths,
                                         std::int32_t max_step) noexcept;

}  // namespace convexcut::velodyne
