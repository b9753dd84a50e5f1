// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/xsens/mt_data_id.hpp"

namespace convexcut::simulation {

// Builds one MTData2 message (layout: drivers/xsens/xbus.hpp), item by item, float32 and ENU.
class MtData2Writer {
 public:
  void add(xsens::DataType type, std::uint16_t value);
  void add(xsens::DataType type, std::uint32_t value);
  void add(xsens::DataType type, std::span<const float> values);

  // The whole frame with its checksum. Throws std::length_error over 254 bytes of items.
  [[nodiscard]] std::vector<std::byte> frame() const;

 private:
  void begin_item(xsens::DataType type, std::size_t size);
  template <class Unsigned>
  void append(Unsigned value);

  std::vector<std::byte> items_;
};

}  // namespace convexcut::simulation
