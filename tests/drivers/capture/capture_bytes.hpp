// SPDX-License-Identifier: Apache-2.0
//
// Capture files and network frames, built byte by byte without the code under test.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace convexcut::test {

using Octets = std::vector<std::byte>;

// Appends numbers in one byte order.
class OctetWriter {
 public:
  explicit OctetWriter(std::endian order = std::endian::big) : order_(order) {}
  OctetWriter& u8(unsigned value) { return number(value, 1); }
  OctetWriter& u16(unsigned value) { return number(value, 2); }
  OctetWriter& u32(std::uint64_t value) { return number(value, 4); }
  OctetWriter& octets(const Octets& more);
  OctetWriter& zeros(std::size_t count);
  [[nodiscard]] const Octets& get() const { return out_; }

 private:
  OctetWriter& number(std::uint64_t value, unsigned size);
  std::endian order_;
  Octets out_;
};

[[nodiscard]] Octets text(std::string_view characters);

// A file header and records of the pcap format.
struct PcapBuilder {
  static constexpr std::uint32_t kMicroseconds = 0xA1B2C3D4;
  static constexpr std::uint32_t kNanoseconds = 0xA1B23C4D;

  explicit PcapBuilder(std::uint32_t link_type, std::uint32_t magic = kMicroseconds,
                       std::endian order = std::endian::little);
  PcapBuilder& record(std::uint32_t seconds, std::uint32_t fraction, const Octets& bytes);
  // What a snapshot length leaves of a longer record.
  PcapBuilder& cut_record(const Octets& bytes, std::size_t original_length);
  [[nodiscard]] const Octets& get() const { return out.get(); }

  OctetWriter out;
};

// One pcapng section with one interface. `resolution` is if_tsresol: 6 or 9.
[[nodiscard]] Octets pcapng(std::uint16_t link_type, std::uint8_t resolution,
                            std::uint64_t timestamp, const Octets& bytes, std::endian order);

struct Udp {
  std::uint32_t source = 0xC0A801C9;
  std::uint32_t destination = 0xFFFFFFFF;
  std::uint16_t source_port = 2368;
  std::uint16_t destination_port = 2368;
  Octets payload;
};

inline constexpr std::uint16_t kEtherTypeIpv4 = 0x0800;
inline constexpr std::uint16_t kEtherTypeIpv6 = 0x86DD;

[[nodiscard]] Octets udp(const Udp& datagram);
// `options` is a multiple of four bytes; `fragment` the flags and offset field.
[[nodiscard]] Octets ipv4(const Udp& datagram, const Octets& options = {},
                          std::uint16_t fragment = 0);
[[nodiscard]] Octets ipv6(const Udp& datagram);
[[nodiscard]] Octets ethernet(std::uint16_t ether_type, const Octets& payload);
[[nodiscard]] Octets vlan_tag(std::uint16_t next_ether_type, const Octets& payload);
[[nodiscard]] Octets linux_cooked(std::uint16_t ether_type, const Octets& payload);
[[nodiscard]] Octets linux_cooked2(std::uint16_t ether_type, const Octets& payload);

void write_file(const std::filesystem::path& file, const Octets& bytes);

}  // namespace convexcut::test
