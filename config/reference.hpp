// SPDX-License-Identifier: Apache-2.0
//
// The schema as documents.
#pragma once

#include <string>

#include "config/config.hpp"

namespace convexcut::config {

// A TOML file of all keys with these values, each under a comment of its meaning, unit, range and
// default. load_text() gives the same configuration again.
[[nodiscard]] std::string to_toml(const Config& config);

// docs/configuration.md.
[[nodiscard]] std::string reference_markdown();

}  // namespace convexcut::config
