// SPDX-License-Identifier: Apache-2.0
#include "daemon/command_line/rate.hpp"

#include <charconv>
#include <cmath>

#include "daemon/command_line/exit_status.hpp"

namespace convexcut::command_line {

double parse_rate(const std::string& text) {
  if (text == "max") return 0.0;
  double rate = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), rate);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(rate) ||
      rate <= 0.0) {
    throw UsageError("--rate: expected a number above 0 or max, found \"" + text + "\"");
  }
  return rate;
}

}  // namespace convexcut::command_line
