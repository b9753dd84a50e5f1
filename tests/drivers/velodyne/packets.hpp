// SPDX-License-Identifier: Apache-2.0
//
// Hand-built datagrams. Offsets are literals from the manuals, on purpose not the decoder's
// constants.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace convexcut::velodyne::test {

// A valid HDL-32E single-return packet without returns, from which a test departs: azimuths 100.00°
// onwards in steps of 0.16°, timestamp 1000.
class DataPacket {
 public:
  DataPacket();

  DataPacket& azimuth(std::size_t block, std::uint16_t centidegrees);
  // Blocks in groups of `repeat` equal azimuths, `step` apart, wrapping at 36000.
  DataPacket& azimuths(std::uint16_t first, std::uint16_t step, std::size_t repeat = 1);
  DataPacket& flag(std::size_t block, std::uint8_t first, std::uint8_t second);
  DataPacket& echo(std::size_t block, std::size_t slot, std::uint16_t ticks,
                   std::uint8_t intensity = 0);
  DataPacket& timestamp(std::uint32_t micros);
  DataPacket& mode(std::uint8_t mode);
  DataPacket& product(std::uint8_t product);

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  void put_u16(std::size_t at, std::uint16_t value);

  std::array<std::byte, 1206> bytes_{};
};

// A valid position packet: timestamp 0, PPS absent, no sentence, no motion words.
class PositionDatagram {
 public:
  PositionDatagram& word(std::size_t at, std::uint16_t value);
  PositionDatagram& timestamp(std::uint32_t micros);
  PositionDatagram& pps(std::uint8_t state);
  PositionDatagram& sentence(std::string_view text);
  PositionDatagram& byte(std::size_t at, std::uint8_t value);

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::array<std::byte, 512> bytes_{};
};

inline constexpr std::uint8_t kSingle = 0x37;
inline constexpr std::uint8_t kDual = 0x39;

}  // namespace convexcut::velodyne::test
