// SPDX-License-Identifier: Apache-2.0
//
// Configuration from a TOML file and from --set overrides. Nothing is printed here.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "config/config.hpp"

namespace convexcut::config {

// A configuration that cannot be used. what() is all there is wrong with it, one line each without
// a final newline: the place (file and line, or the override), the key, what was expected and
// found:
//   robot.toml:12: lidar.min_range_m: expected a number 0 … 200, found "abc"
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The defaults, changed by the file if there is one, then by the overrides in their order. An
// override is "key=value"; the value is written as in TOML, and a text needs no quotes. Throws
// ConfigError.
[[nodiscard]] Config load(const std::optional<std::filesystem::path>& file,
                          std::span<const std::string> overrides = {});

// The same for TOML in memory; `name` stands for the file in messages.
[[nodiscard]] Config load_text(std::string_view toml, std::string_view name,
                               std::span<const std::string> overrides = {});

}  // namespace convexcut::config
