// SPDX-License-Identifier: Apache-2.0
#include "tests/drivers/velodyne/capture.hpp"

#include <stdexcept>

#include "drivers/wire.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::velodyne::test {

std::vector<CapturedDatagram> read_capture(const std::filesystem::path& file) {
  constexpr std::size_t kFileHeader = 24;
  constexpr std::size_t kRecordHeader = 16;
  constexpr std::size_t kNetworkHeaders = 42;  // Ethernet 14, IPv4 20, UDP 8
  const std::vector<std::byte> bytes = convexcut::test::read_bytes(file);
  const wire::Bytes all(bytes);
  if (all.size() < kFileHeader || wire::load_le<std::uint32_t>(all, 0) != 0xA1B2C3D4) {
    throw std::runtime_error("not a microsecond pcap: " + file.string());
  }
  std::vector<CapturedDatagram> datagrams;
  for (std::size_t at = kFileHeader; at + kRecordHeader <= all.size();) {
    const std::int64_t seconds = wire::load_le<std::uint32_t>(all, at);
    const std::int64_t micros = wire::load_le<std::uint32_t>(all, at + 4);
    const std::size_t length = wire::load_le<std::uint32_t>(all, at + 8);
    const wire::Bytes frame = all.subspan(at + kRecordHeader, length);
    const wire::Bytes payload = frame.subspan(kNetworkHeaders);
    datagrams.push_back({from_ns<HostTime>((seconds * 1'000'000 + micros) * 1'000),
                         wire::load_be<std::uint16_t>(frame, 34),
                         wire::load_be<std::uint16_t>(frame, 36),
                         {payload.begin(), payload.end()}});
    at += kRecordHeader + length;
  }
  return datagrams;
}

}  // namespace convexcut::velodyne::test
