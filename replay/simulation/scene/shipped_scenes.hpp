// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace convexcut::simulation {

// A file of replay/simulation/scenes/, as it was when the program was built.
struct ShippedScene {
  std::string_view name;
  std::string_view text;
};

[[nodiscard]] std::span<const ShippedScene> shipped_scenes() noexcept;

}  // namespace convexcut::simulation
