// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace convexcut::command_line {

// What --rate says: recorded seconds per second; 0 for "max". Throws UsageError.
[[nodiscard]] double parse_rate(const std::string& text);

}  // namespace convexcut::command_line
