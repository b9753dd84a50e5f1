// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/wire/mtdata2_writer.hpp"

#include <bit>
#include <stdexcept>

#include "drivers/wire.hpp"
#include "drivers/xsens/xbus_writer.hpp"

namespace convexcut::simulation {

template <class Unsigned>
void MtData2Writer::append(Unsigned value) {
  const std::size_t at = items_.size();
  items_.resize(at + sizeof(value));
  wire::store_be<Unsigned>(items_, at, value);
}

void MtData2Writer::begin_item(xsens::DataType type, std::size_t size) {
  append(static_cast<std::uint16_t>(type));
  append(static_cast<std::uint8_t>(size));
}

void MtData2Writer::add(xsens::DataType type, std::uint16_t value) {
  begin_item(type, sizeof(value));
  append(value);
}

void MtData2Writer::add(xsens::DataType type, std::uint32_t value) {
  begin_item(type, sizeof(value));
  append(value);
}

void MtData2Writer::add(xsens::DataType type, std::span<const float> values) {
  begin_item(type, values.size_bytes());
  for (const float value : values) append(std::bit_cast<std::uint32_t>(value));
}

std::vector<std::byte> MtData2Writer::frame() const {
  if (items_.size() >= xsens::kExtendedLength) {
    throw std::length_error("more than 254 bytes of items in an MTData2 message");
  }
  return xsens::make_frame(xsens::MessageId::mtdata2, items_);
}

}  // namespace convexcut::simulation
