// SPDX-License-Identifier: Apache-2.0
//
// Real clouds, read with as little code as does it: these tests need nothing of the drivers.
#pragma once

#include <filesystem>
#include <vector>

#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut::test {

// The x, y, z (the first three fields, floats) of a PCD v0.7 file with DATA binary or
// binary_compressed, without points that are not finite or all zero. Throws std::runtime_error.
[[nodiscard]] Cloud read_pcd(const std::filesystem::path& path);

// The whole revolutions of an HDL-32E in a pcap file of Ethernet frames, single return, in the
// lidar's frame (REP-103), with the azimuth of the block for all of its lasers.
[[nodiscard]] std::vector<Cloud> read_hdl32e_revolutions(const std::filesystem::path& path);

}  // namespace convexcut::test
