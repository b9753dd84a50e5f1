// SPDX-License-Identifier: Apache-2.0
//
// One revolution of an HDL-32E in a room as its datagrams, and the orientations of a carried rig
// during it: what the stages are measured on.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "core/scan/orientation_track.hpp"
#include "core/time.hpp"
#include "replay/simulation/wire/hdl32e_packets.hpp"

namespace convexcut::bench {

inline constexpr HostTime kRevolutionBegin{std::chrono::hours{500'000}};

struct Revolution {
  std::vector<simulation::DataPacketBytes> packets;  // 180: 2160 firings, 358.3° at 10 Hz
  std::size_t returns = 0;
};

// missing: the share of laser pulses without a return, most of them of the upper lasers where there
// is no ceiling, as outdoors. Deterministic.
[[nodiscard]] Revolution revolution(double missing);

// A rig that sways by ±5° about all axes, sampled at 400 Hz from before the revolution to after it.
[[nodiscard]] OrientationTrack swaying_rig();

}  // namespace convexcut::bench
