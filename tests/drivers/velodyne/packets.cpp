// SPDX-License-Identifier: Apache-2.0
#include "tests/drivers/velodyne/packets.hpp"

#include <algorithm>

namespace convexcut::velodyne::test {

DataPacket::DataPacket() {
  for (std::size_t block = 0; block < 12; ++block) flag(block, 0xFF, 0xEE);
  azimuths(10000, 16).timestamp(1000).mode(kSingle).product(0x21);
}

DataPacket& DataPacket::azimuth(std::size_t block, std::uint16_t centidegrees) {
  put_u16(100 * block + 2, centidegrees);
  return *this;
}

DataPacket& DataPacket::azimuths(std::uint16_t first, std::uint16_t step, std::size_t repeat) {
  for (std::size_t block = 0; block < 12; ++block) {
    azimuth(block, static_cast<std::uint16_t>((first + step * (block / repeat)) % 36000));
  }
  return *this;
}

DataPacket& DataPacket::flag(std::size_t block, std::uint8_t first, std::uint8_t second) {
  bytes_[100 * block] = std::byte{first};
  bytes_[100 * block + 1] = std::byte{second};
  return *this;
}

DataPacket& DataPacket::echo(std::size_t block, std::size_t slot, std::uint16_t ticks,
                             std::uint8_t intensity) {
  const std::size_t at = 100 * block + 4 + 3 * slot;
  put_u16(at, ticks);
  bytes_[at + 2] = std::byte{intensity};
  return *this;
}

DataPacket& DataPacket::timestamp(std::uint32_t micros) {
  put_u16(1200, static_cast<std::uint16_t>(micros & 0xFFFFU));
  put_u16(1202, static_cast<std::uint16_t>(micros >> 16U));
  return *this;
}

DataPacket& DataPacket::mode(std::uint8_t mode) {
  bytes_[1204] = std::byte{mode};
  return *this;
}

DataPacket& DataPacket::product(std::uint8_t product) {
  bytes_[1205] = std::byte{product};
  return *this;
}

void DataPacket::put_u16(std::size_t at, std::uint16_t value) {
  bytes_[at] = static_cast<std::byte>(value & 0xFFU);
  bytes_[at + 1] = static_cast<std::byte>(value >> 8U);
}

PositionDatagram& PositionDatagram::byte(std::size_t at, std::uint8_t value) {
  bytes_[at] = std::byte{value};
  return *this;
}

PositionDatagram& PositionDatagram::word(std::size_t at, std::uint16_t value) {
  byte(at, static_cast<std::uint8_t>(value & 0xFFU));
  return byte(at + 1, static_cast<std::uint8_t>(value >> 8U));
}

PositionDatagram& PositionDatagram::timestamp(std::uint32_t micros) {
  word(198, static_cast<std::uint16_t>(micros & 0xFFFFU));
  return word(200, static_cast<std::uint16_t>(micros >> 16U));
}

PositionDatagram& PositionDatagram::pps(std::uint8_t state) { return byte(202, state); }

PositionDatagram& PositionDatagram::sentence(std::string_view text) {
  std::ranges::transform(text, bytes_.begin() + 206,
                         [](char c) { return static_cast<std::byte>(c); });
  return *this;
}

}  // namespace convexcut::velodyne::test
