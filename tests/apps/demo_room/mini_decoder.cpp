// SPDX-License-Identifier: Apache-2.0
#include "tests/apps/demo_room/mini_decoder.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace convexcut::test {
namespace {

std::uint32_t little(const ByteString& b, std::size_t at, int size) {
  std::uint32_t value = 0;
  for (int i = size - 1; i >= 0; --i) value = value << 8U | b.at(at + static_cast<std::size_t>(i));
  return value;
}

std::uint32_t big(const ByteString& b, std::size_t at, int size) {
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i) value = value << 8U | b.at(at + static_cast<std::size_t>(i));
  return value;
}

float big_float(const ByteString& b, std::size_t at) {
  const std::uint32_t bits = big(b, at, 4);
  float value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

ByteString part(const ByteString& b, std::size_t at, std::size_t size) {
  if (at + size > b.size()) throw std::runtime_error("file too short");
  const auto begin = b.begin() + static_cast<std::ptrdiff_t>(at);
  return {begin, begin + static_cast<std::ptrdiff_t>(size)};
}

}  // namespace

PcapFile read_pcap(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const ByteString all{std::istreambuf_iterator<char>(in), {}};
  if (little(all, 0, 4) != 0xA1B23C4D) throw std::runtime_error("no nanosecond pcap");
  PcapFile pcap{little(all, 20, 4), {}};
  for (std::size_t at = 24; at < all.size();) {
    const std::size_t size = little(all, at + 8, 4);
    if (little(all, at + 12, 4) != size) throw std::runtime_error("cut record");
    pcap.records.push_back(
        {little(all, at, 4) * std::int64_t{1'000'000'000} + little(all, at + 4, 4),
         part(all, at + 16, size)});
    at += 16 + size;
  }
  return pcap;
}

std::vector<MiniDatagram> datagrams(const PcapFile& pcap) {
  std::vector<MiniDatagram> out;
  for (const PcapRecord& record : pcap.records) {
    const ByteString& b = record.bytes;
    const std::size_t size = big(b, 38, 2);  // UDP length, with its header
    out.push_back(
        {record.stamp_ns, static_cast<std::uint16_t>(big(b, 36, 2)), part(b, 42, size - 8)});
  }
  return out;
}

std::vector<MiniDataPacket> data_packets(const PcapFile& pcap) {
  std::vector<MiniDataPacket> out;
  for (const MiniDatagram& datagram : datagrams(pcap)) {
    if (datagram.destination_port != 2368) continue;
    const ByteString& b = datagram.payload;
    MiniDataPacket packet;
    packet.stamp_ns = datagram.stamp_ns;
    for (std::size_t i = 0; i < 12; ++i) {
      packet.blocks[i].flag = static_cast<std::uint16_t>(little(b, 100 * i, 2));
      packet.blocks[i].azimuth = static_cast<std::uint16_t>(little(b, 100 * i + 2, 2));
      for (std::size_t c = 0; c < 32; ++c) {
        packet.blocks[i].distance[c] =
            static_cast<std::uint16_t>(little(b, 100 * i + 4 + 3 * c, 2));
      }
    }
    packet.timestamp_us = little(b, 1200, 4);
    packet.mode = b.at(1204);
    packet.product = b.at(1205);
    out.push_back(packet);
  }
  return out;
}

std::vector<MiniImu> imu_frames(const PcapFile& pcap) {
  ByteString b;
  for (const PcapRecord& record : pcap.records) {
    b.insert(b.end(), record.bytes.begin(), record.bytes.end());
  }
  std::vector<MiniImu> out;
  for (std::size_t at = 0; at < b.size(); at += 73) {
    const ByteString f = part(b, at, 73);
    unsigned sum = 0;
    for (std::size_t i = 1; i < f.size(); ++i) sum += f[i];
    if (sum % 256 != 0) throw std::runtime_error("checksum of frame " + std::to_string(at / 73));
    // Preamble, bus id, MTData2, length; then the heads of the items where they must be.
    if (big(f, 0, 4) != 0xFAFF3644) throw std::runtime_error("frame head");
    if (big(f, 4, 3) != 0x102002 || big(f, 9, 3) != 0x106004 || big(f, 16, 3) != 0x201010 ||
        big(f, 35, 3) != 0x40200C || big(f, 50, 3) != 0x80200C || big(f, 65, 3) != 0xE02004) {
      throw std::runtime_error("item head");
    }
    MiniImu imu;
    imu.counter = static_cast<std::uint16_t>(big(f, 7, 2));
    imu.ticks = big(f, 12, 4);
    for (std::size_t i = 0; i < 4; ++i) imu.wxyz[i] = big_float(f, 19 + 4 * i);
    for (std::size_t i = 0; i < 3; ++i) imu.acceleration[i] = big_float(f, 38 + 4 * i);
    for (std::size_t i = 0; i < 3; ++i) imu.rate[i] = big_float(f, 53 + 4 * i);
    imu.status = big(f, 68, 4);
    out.push_back(imu);
  }
  return out;
}

std::vector<MiniCanFrame> candump_frames(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<MiniCanFrame> out;
  for (std::string line; std::getline(in, line);) {
    // (1772359198.000509) can0 005#075BCD15
    if (line.size() < 31 || line[0] != '(' || line[11] != '.' || line.substr(18, 7) != ") can0 " ||
        line[28] != '#') {
      throw std::runtime_error("not a candump line: " + line);
    }
    MiniCanFrame frame{std::stoll(line.substr(1, 10)) * 1'000'000 + std::stoll(line.substr(12, 6)),
                       static_cast<std::uint32_t>(std::stoul(line.substr(25, 3), nullptr, 16)),
                       {}};
    const std::string digits = line.substr(29);
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
      frame.data.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    }
    out.push_back(frame);
  }
  return out;
}

}  // namespace convexcut::test
