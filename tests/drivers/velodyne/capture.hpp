// SPDX-License-Identifier: Apache-2.0
//
// The UDP payloads of a recording, read with as little as these tests need: little-endian
// microsecond pcap, Ethernet, IPv4 without options. The product's own reader has tests of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/time.hpp"

namespace convexcut::velodyne::test {

struct CapturedDatagram {
  HostTime stamp;
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  std::vector<std::byte> payload;
};

[[nodiscard]] std::vector<CapturedDatagram> read_capture(const std::filesystem::path& file);

}  // namespace convexcut::velodyne::test
