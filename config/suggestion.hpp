// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace convexcut::config {

// "; did you mean lidar.model?" for a name that is no key, or no section. Empty when nothing is
// near.
[[nodiscard]] std::string suggest_key(std::string_view unknown);
[[nodiscard]] std::string suggest_section(std::string_view unknown);

}  // namespace convexcut::config
