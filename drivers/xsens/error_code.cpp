// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/error_code.hpp"

#include <array>

namespace convexcut::xsens {
namespace {

struct ErrorRange {
  std::uint8_t first;
  std::uint8_t last;
  std::string_view meaning;
};

constexpr std::array kErrors = {
    ErrorRange{0, 0, "ok"},
    ErrorRange{1, 1, "no bus communication"},
    ErrorRange{2, 2, "bus not ready"},
    ErrorRange{3, 3, "invalid period"},
    ErrorRange{4, 4, "invalid or unimplemented message"},
    ErrorRange{16, 18, "bus initialisation failed"},
    ErrorRange{20, 21, "setting the bus id failed"},
    ErrorRange{24, 29, "measurement failed"},
    ErrorRange{30, 30, "timer overflow"},
    ErrorRange{32, 32, "invalid baud rate"},
    ErrorRange{33, 33, "invalid parameter"},
    ErrorRange{35, 35, "transmit buffer full"},
    ErrorRange{36, 36, "transmit buffer overflow"},
    ErrorRange{37, 37, "wireless failure"},
    ErrorRange{40, 40, "device error"},
    ErrorRange{41, 41, "data overflow: baud rate too low for the configuration"},
    ErrorRange{42, 42, "buffer overflow during an outage"},
    ErrorRange{43, 43, "external trigger error"},
    ErrorRange{44, 44, "sample stream error"},
    ErrorRange{45, 45, "power dip"},
    ErrorRange{46, 46, "overcurrent"},
    ErrorRange{47, 47, "overheating"},
    ErrorRange{49, 49, "invalid filter profile"},
    ErrorRange{50, 50, "invalid stored settings"},
    ErrorRange{51, 51, "access denied"},
    ErrorRange{53, 53, "output configuration error"},
};

}  // namespace

std::string_view describe_error(std::uint8_t code) noexcept {
  for (const ErrorRange& range : kErrors) {
    if (code >= range.first && code <= range.last) return range.meaning;
  }
  return "unknown error";
}

}  // namespace convexcut::xsens
