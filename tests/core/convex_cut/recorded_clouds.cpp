// SPDX-License-Identifier: Apache-2.0
#include "tests/core/convex_cut/recorded_clouds.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/support/recordings.hpp"

namespace convexcut::test {
namespace {

using Bytes = std::span<const std::byte>;

template <class Value>
[[nodiscard]] Value load(Bytes bytes, std::size_t offset) {
  if (offset + sizeof(Value) > bytes.size()) throw std::runtime_error("file too short");
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof(Value));
  return value;
}

// LZF (Marc Lehmann's liblzf): runs of literals, and copies of what has been put out before.
[[nodiscard]] std::vector<std::byte> decompress_lzf(Bytes in, std::size_t out_size) {
  std::vector<std::byte> out;
  out.reserve(out_size);
  std::size_t at = 0;
  const auto next = [&] { return static_cast<std::size_t>(load<std::uint8_t>(in, at++)); };
  while (at < in.size()) {
    const std::size_t control = next();
    if (control < 32) {
      for (std::size_t i = 0; i <= control; ++i) out.push_back(static_cast<std::byte>(next()));
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7) length += next();
    const std::size_t back = ((control & 31U) << 8U) + next() + 1;
    if (back > out.size()) throw std::runtime_error("LZF reference before the start");
    for (std::size_t i = 0; i < length + 2; ++i) out.push_back(out[out.size() - back]);
  }
  if (out.size() != out_size) throw std::runtime_error("LZF size");
  return out;
}

struct PcdHeader {
  std::size_t fields = 0;
  std::size_t points = 0;
  bool compressed = false;
  std::size_t size = 0;  // bytes of the header itself
};

[[nodiscard]] PcdHeader read_pcd_header(Bytes file) {
  PcdHeader header;
  while (true) {
    std::string line;
    for (char c = load<char>(file, header.size++); c != '\n'; c = load<char>(file, header.size++)) {
      line.push_back(c);
    }
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "FIELDS") {
      for (std::string field; words >> field;) ++header.fields;
    } else if (key == "POINTS") {
      words >> header.points;
    } else if (key == "DATA") {
      std::string kind;
      words >> kind;
      header.compressed = kind == "binary_compressed";
      return header;
    }
  }
}

void add_if_valid(Cloud& cloud, float x, float y, float z) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return;
  if (x == 0.0F && y == 0.0F && z == 0.0F) return;
  cloud.x.push_back(x);
  cloud.y.push_back(y);
  cloud.z.push_back(z);
}

// Offsets in a captured HDL-32E data packet: Ethernet, IPv4 and UDP headers, then 12 blocks.
constexpr std::size_t kPcapHeader = 24;
constexpr std::size_t kRecordHeader = 16;
constexpr std::size_t kFrameHeaders = 42;
constexpr std::size_t kPayload = 1206;
constexpr std::size_t kBlocks = 12;
constexpr std::size_t kBlockSize = 100;
constexpr std::size_t kLasers = 32;

void add_block(Cloud& cloud, Bytes block) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double azimuth = load<std::uint16_t>(block, 2) * 0.01 * kDegree;
  for (std::size_t laser = 0; laser < kLasers; ++laser) {
    const double range = load<std::uint16_t>(block, 4 + 3 * laser) * 0.002;
    if (range == 0.0) continue;
    const std::size_t ring = laser % 2 == 0 ? laser / 2 : 16 + laser / 2;
    const double elevation = (-92.0 + 4.0 * static_cast<double>(ring)) / 3.0 * kDegree;
    cloud.add(range * std::cos(elevation) * std::cos(azimuth),
              -range * std::cos(elevation) * std::sin(azimuth), range * std::sin(elevation));
  }
}

}  // namespace

Cloud read_pcd(const std::filesystem::path& path) {
  const std::vector<std::byte> file = read_bytes(path);
  const PcdHeader header = read_pcd_header(file);
  const Bytes data = Bytes(file).subspan(header.size);
  Cloud cloud;
  if (!header.compressed) {  // point by point
    for (std::size_t i = 0; i < header.points; ++i) {
      const std::size_t at = i * header.fields * sizeof(float);
      add_if_valid(cloud, load<float>(data, at), load<float>(data, at + 4),
                   load<float>(data, at + 8));
    }
    return cloud;
  }
  // Two sizes, then field by field.
  const std::vector<std::byte> columns =
      decompress_lzf(data.subspan(8, load<std::uint32_t>(data, 0)), load<std::uint32_t>(data, 4));
  for (std::size_t i = 0; i < header.points; ++i) {
    const auto value = [&](std::size_t field) {
      return load<float>(columns, (field * header.points + i) * sizeof(float));
    };
    add_if_valid(cloud, value(0), value(1), value(2));
  }
  return cloud;
}

std::vector<Cloud> read_hdl32e_revolutions(const std::filesystem::path& path) {
  const std::vector<std::byte> file = read_bytes(path);
  std::vector<Cloud> revolutions(1);
  int last_azimuth = -1;
  for (std::size_t at = kPcapHeader; at + kRecordHeader <= file.size();) {
    const auto length = load<std::uint32_t>(file, at + 8);
    const Bytes frame = Bytes(file).subspan(at + kRecordHeader, length);
    at += kRecordHeader + length;
    if (length != kFrameHeaders + kPayload) continue;
    for (std::size_t i = 0; i < kBlocks; ++i) {
      const Bytes block = frame.subspan(kFrameHeaders + i * kBlockSize, kBlockSize);
      const int azimuth = load<std::uint16_t>(block, 2) % 36000;
      if (azimuth < last_azimuth) revolutions.emplace_back();
      last_azimuth = azimuth;
      add_block(revolutions.back(), block);
    }
  }
  if (revolutions.size() < 3) throw std::runtime_error("no whole revolution");
  return {revolutions.begin() + 1, revolutions.end() - 1};
}

}  // namespace convexcut::test
