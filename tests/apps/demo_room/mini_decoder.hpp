// SPDX-License-Identifier: Apache-2.0
//
// Decoders of their own for the files of the demo room, written from the specifications and without
// the project's drivers, so that a mistake made twice would have to be made in two ways.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace convexcut::test {

using ByteString = std::vector<std::uint8_t>;

struct PcapRecord {
  std::int64_t stamp_ns = 0;
  ByteString bytes;
};

struct PcapFile {
  std::uint32_t link_type = 0;
  std::vector<PcapRecord> records;
};

// Little-endian pcap with nanosecond stamps. Throws std::runtime_error.
PcapFile read_pcap(const std::filesystem::path& file);

// The UDP payload of an Ethernet frame with a 20-byte IPv4 header.
struct MiniDatagram {
  std::int64_t stamp_ns = 0;
  std::uint16_t destination_port = 0;
  ByteString payload;
};
std::vector<MiniDatagram> datagrams(const PcapFile& pcap);

struct MiniBlock {
  std::uint16_t flag = 0;
  std::uint16_t azimuth = 0;                 // 0.01°
  std::array<std::uint16_t, 32> distance{};  // 2 mm
};

struct MiniDataPacket {
  std::int64_t stamp_ns = 0;
  std::array<MiniBlock, 12> blocks{};
  std::uint32_t timestamp_us = 0;
  std::uint8_t mode = 0;
  std::uint8_t product = 0;
};
std::vector<MiniDataPacket> data_packets(const PcapFile& pcap);

// MTData2 frames of 73 bytes as the demo's IMU sends them. Throws on a bad byte.
struct MiniImu {
  std::uint16_t counter = 0;
  std::uint32_t ticks = 0;  // 0.1 ms
  std::array<float, 4> wxyz{};
  std::array<float, 3> acceleration{};
  std::array<float, 3> rate{};
  std::uint32_t status = 0;
};
std::vector<MiniImu> imu_frames(const PcapFile& pcap);

struct MiniCanFrame {
  std::int64_t stamp_us = 0;
  std::uint32_t id = 0;
  ByteString data;

  [[nodiscard]] std::int16_t i16(std::size_t n) const {
    return static_cast<std::int16_t>(data.at(2 * n) << 8 | data.at(2 * n + 1));
  }
};
std::vector<MiniCanFrame> candump_frames(const std::filesystem::path& file);

}  // namespace convexcut::test
