// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace convexcut::config {

// "; did you mean lidar.model?" for a name that is no key, or no section when it has no dot. Empty
// when nothing is near.
[[nodiscard]] std::string suggestion(std::string_view unknown);

}  // namespace convexcut::config
