// SPDX-License-Identifier: Apache-2.0
#include "drivers/recorder/record_ring.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

namespace convexcut::recorder {
namespace {

// In front of the payload. Never leaves the process, so that its layout is the compiler's.
struct Header {
  HostTime stamp;
  Ipv4Address source;
  Ipv4Address destination;
  std::uint16_t source_port;
  std::uint16_t destination_port;
  capture::RecordKind kind;
  bool has_source;
  bool has_destination;
};
static_assert(std::is_trivially_copyable_v<Header>);

std::optional<Ipv4Address> address(bool has, Ipv4Address value) noexcept {
  return has ? std::optional(value) : std::nullopt;
}

}  // namespace

void RecordRing::on_record(const capture::Record& record) noexcept {
  const std::span<std::byte> room = ring_.claim(sizeof(Header) + record.payload.size());
  if (room.empty()) return;
  const Header header{record.stamp,
                      record.source.value_or(Ipv4Address{}),
                      record.destination.value_or(Ipv4Address{}),
                      record.source_port,
                      record.destination_port,
                      record.kind,
                      record.source.has_value(),
                      record.destination.has_value()};
  std::memcpy(room.data(), &header, sizeof header);
  std::ranges::copy(record.payload, room.begin() + sizeof header);
  ring_.commit();
}

bool RecordRing::front(capture::Record& record) noexcept {
  const std::span<const std::byte> bytes = ring_.front();
  if (bytes.empty()) return false;
  Header header;
  std::memcpy(&header, bytes.data(), sizeof header);
  record.stamp = header.stamp;
  record.kind = header.kind;
  record.source_port = header.source_port;
  record.destination_port = header.destination_port;
  record.source = address(header.has_source, header.source);
  record.destination = address(header.has_destination, header.destination);
  record.payload = bytes.subspan(sizeof header);
  return true;
}

}  // namespace convexcut::recorder
