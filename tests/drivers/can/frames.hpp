// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "drivers/can/can_frame.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::can::test {

inline CanFrame make_frame(std::uint32_t id, std::string_view data_hex, HostTime stamp = {}) {
  CanFrame frame;
  frame.stamp = stamp;
  frame.id = id;
  const auto data = convexcut::test::hex(data_hex);
  std::copy(data.begin(), data.end(), frame.data.begin());
  frame.length = static_cast<std::uint8_t>(data.size());
  return frame;
}

}  // namespace convexcut::can::test
