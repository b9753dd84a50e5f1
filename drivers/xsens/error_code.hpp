// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace convexcut::xsens {

// What the code of an Xbus error message (0x42) means, e.g. 41 "data overflow: baud rate too low
// for the configuration"; "unknown error" for codes without a meaning (xsresultvalue.h).
[[nodiscard]] std::string_view describe_error(std::uint8_t code) noexcept;

}  // namespace convexcut::xsens
