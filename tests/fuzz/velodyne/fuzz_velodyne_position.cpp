// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a position packet, and as an NMEA sentence on its own: with its checksum put right,
// so that the fields behind it are reached.
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "drivers/velodyne/position_packet.hpp"

namespace {

using namespace convexcut;
using namespace convexcut::velodyne;

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const NmeaFix& fix) {
  if (fix.time_of_day) {
    require(*fix.time_of_day >= Duration{0});
    require(*fix.time_of_day < std::chrono::hours{24} + std::chrono::seconds{1});
  }
  if (fix.date) require(fix.date->ok());
  if (fix.latitude) require(std::abs(fix.latitude->value) <= 90.0);
  if (fix.longitude) require(std::abs(fix.longitude->value) <= 180.0);
}

void parse_with_checksum(std::string_view body) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  std::string text = "$";
  text.append(body);
  text += '*';
  text += kDigits[sum / 16];
  text += kDigits[sum % 16];
  NmeaFix fix;
  if (parse_nmea(text, fix) == NmeaStatus::ok) check(fix);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> payload = std::as_bytes(std::span(data, size));
  PositionPacket packet;
  if (decode_position_packet(payload, packet) == PositionStatus::ok) {
    require(packet.time.count < wire_layout::kMicrosPerHour);
    require(packet.pps <= PpsState::error || packet.pps == PpsState::unknown);
    check(packet.fix);
  }
  parse_with_checksum({reinterpret_cast<const char*>(data), size});
  return 0;
}
