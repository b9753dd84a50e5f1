// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace convexcut::config {

// "; did you mean lidar.model?" for a name that is no key, or no section. Empty when nothing is
// near.
[[nodiscard]] std::string suggest_key(std::string_view unknown);
[[nodiscard]] std::string suggest_section(std::string_view unknown);

// The same for a name that is not among `known`, whatever these are.
[[nodiscard]] std::string suggest(std::string_view unknown,
                                  std::span<const std::string_view> known);

}  // namespace convexcut::config
