// SPDX-License-Identifier: Apache-2.0
#include "tests/drivers/capture/capture_bytes.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace convexcut::test {

OctetWriter& OctetWriter::number(std::uint64_t value, unsigned size) {
  for (unsigned i = 0; i < size; ++i) {
    const unsigned byte = order_ == std::endian::big ? size - 1 - i : i;
    out_.push_back(static_cast<std::byte>(value >> (8U * byte)));
  }
  return *this;
}

OctetWriter& OctetWriter::octets(const Octets& more) {
  out_.insert(out_.end(), more.begin(), more.end());
  return *this;
}

OctetWriter& OctetWriter::zeros(std::size_t count) {
  out_.resize(out_.size() + count);
  return *this;
}

Octets text(std::string_view characters) {
  Octets out;
  std::ranges::transform(characters, std::back_inserter(out),
                         [](char c) { return static_cast<std::byte>(c); });
  return out;
}

PcapBuilder::PcapBuilder(std::uint32_t link_type, std::uint32_t magic, std::endian order)
    : out(order) {
  out.u32(magic).u16(2).u16(4).zeros(8).u32(65535).u32(link_type);
}

PcapBuilder& PcapBuilder::record(std::uint32_t seconds, std::uint32_t fraction,
                                 const Octets& bytes) {
  out.u32(seconds).u32(fraction).u32(bytes.size()).u32(bytes.size()).octets(bytes);
  return *this;
}

PcapBuilder& PcapBuilder::cut_record(const Octets& bytes, std::size_t original_length) {
  out.u32(0).u32(0).u32(bytes.size()).u32(original_length).octets(bytes);
  return *this;
}

Octets pcapng(std::uint16_t link_type, std::uint8_t resolution, std::uint64_t timestamp,
              const Octets& bytes, std::endian order) {
  OctetWriter out(order);
  constexpr unsigned kSectionSize = 28;
  out.u32(0x0A0D0D0A).u32(kSectionSize).u32(0x1A2B3C4D).u16(1).u16(0);
  out.u32(0xFFFFFFFF).u32(0xFFFFFFFF).u32(kSectionSize);
  constexpr unsigned kInterfaceSize = 32;
  out.u32(1).u32(kInterfaceSize).u16(link_type).u16(0).u32(0);
  out.u16(9).u16(1).u8(resolution).zeros(3);  // if_tsresol, padded
  out.u16(0).u16(0).u32(kInterfaceSize);
  const std::size_t padding = (4 - bytes.size() % 4) % 4;
  const std::size_t packet_size = 32 + bytes.size() + padding;
  out.u32(6).u32(packet_size).u32(0).u32(timestamp >> 32U).u32(timestamp);
  out.u32(bytes.size()).u32(bytes.size()).octets(bytes).zeros(padding).u32(packet_size);
  return out.get();
}

Octets udp(const Udp& datagram) {
  return OctetWriter()
      .u16(datagram.source_port)
      .u16(datagram.destination_port)
      .u16(static_cast<unsigned>(8 + datagram.payload.size()))
      .u16(0)
      .octets(datagram.payload)
      .get();
}

Octets ipv4(const Udp& datagram, const Octets& options, std::uint16_t fragment) {
  const Octets inner = udp(datagram);
  const std::size_t header = 20 + options.size();
  OctetWriter out;
  out.u8(static_cast<unsigned>(0x40 + header / 4)).u8(0);
  out.u16(static_cast<unsigned>(header + inner.size())).u16(0x1234).u16(fragment);
  out.u8(64).u8(17).u16(0).u32(datagram.source).u32(datagram.destination);
  return out.octets(options).octets(inner).get();
}

Octets ipv6(const Udp& datagram) {
  const Octets inner = udp(datagram);
  OctetWriter out;
  out.u32(0x60000000).u16(static_cast<unsigned>(inner.size())).u8(17).u8(64).zeros(32);
  return out.octets(inner).get();
}

Octets ethernet(std::uint16_t ether_type, const Octets& payload) {
  return OctetWriter().zeros(12).u16(ether_type).octets(payload).get();
}

Octets vlan_tag(std::uint16_t next_ether_type, const Octets& payload) {
  return OctetWriter().u16(0x0064).u16(next_ether_type).octets(payload).get();
}

Octets linux_cooked(std::uint16_t ether_type, const Octets& payload) {
  return OctetWriter().u16(0).u16(1).u16(6).zeros(8).u16(ether_type).octets(payload).get();
}

Octets linux_cooked2(std::uint16_t ether_type, const Octets& payload) {
  return OctetWriter()
      .u16(ether_type)
      .u16(0)
      .u32(2)
      .u16(1)
      .u8(0)
      .u8(6)
      .zeros(8)
      .octets(payload)
      .get();
}

void write_file(const std::filesystem::path& file, const Octets& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

}  // namespace convexcut::test
