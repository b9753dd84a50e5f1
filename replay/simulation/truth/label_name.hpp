// SPDX-License-Identifier: Apache-2.0
//
// Labels and materials as the truth files spell them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "replay/simulation/scene/surface_label.hpp"

namespace convexcut::simulation {

inline constexpr std::array<std::string_view, 4> kLabelNames{"none", "structure", "object",
                                                             "dynamic"};
inline constexpr std::array<std::string_view, 3> kMaterialNames{"diffuse", "glass", "mirror"};

[[nodiscard]] constexpr std::string_view name_of(SurfaceLabel label) noexcept {
  return kLabelNames[static_cast<std::size_t>(label)];
}
[[nodiscard]] constexpr std::string_view name_of(Material material) noexcept {
  return kMaterialNames[static_cast<std::size_t>(material)];
}

// Nothing for another word. Value: SurfaceLabel or Material.
template <class Value, std::size_t N>
[[nodiscard]] constexpr std::optional<Value> named(const std::array<std::string_view, N>& names,
                                                   std::string_view name) noexcept {
  for (std::size_t i = 0; i < N; ++i) {
    if (names[i] == name) return static_cast<Value>(i);
  }
  return std::nullopt;
}

}  // namespace convexcut::simulation
