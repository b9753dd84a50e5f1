// SPDX-License-Identifier: Apache-2.0
//
// From labels and materials to the words that files have for them, and back.
#pragma once

#include <optional>
#include <string_view>

#include "replay/simulation/scene/surface_label.hpp"

namespace convexcut::simulation {

// Names: kLabelNames or kMaterialNames. Nothing for a value or a word that is not among them.
template <class Names, class Value>
[[nodiscard]] constexpr std::string_view name_in(const Names& names, Value value) noexcept {
  for (const auto& [name, named] : names) {
    if (named == value) return name;
  }
  return {};
}
template <class Names>
[[nodiscard]] constexpr auto named_in(const Names& names, std::string_view name) noexcept {
  std::optional<decltype(names.front().second)> found;
  for (const auto& [known, value] : names) {
    if (known == name) found = value;
  }
  return found;
}

[[nodiscard]] constexpr std::string_view name_of(SurfaceLabel label) noexcept {
  return label == SurfaceLabel::none ? "none" : name_in(kLabelNames, label);
}
[[nodiscard]] constexpr std::string_view name_of(Material material) noexcept {
  return name_in(kMaterialNames, material);
}

}  // namespace convexcut::simulation
