// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "config/loader.hpp"

namespace convexcut::test {

using Overrides = std::vector<std::string>;

// The lines of the error that loading gives; none when it succeeds.
inline std::vector<std::string> errors_of(std::string_view toml, const Overrides& overrides = {}) {
  std::vector<std::string> lines;
  try {
    static_cast<void>(config::load_text(toml, "robot.toml", overrides));
  } catch (const config::ConfigError& error) {
    std::istringstream text(error.what());
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    EXPECT_FALSE(lines.empty());
  }
  return lines;
}

}  // namespace convexcut::test
