// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace convexcut::simulation {

// What a surface is, in the sense of the paper: structure stays when the room is cleared, objects
// can be moved, dynamic ones move by themselves. `none` is what no surface has: a ray into nothing.
// The numbers are those of the truth files.
enum class SurfaceLabel : std::uint8_t { none = 0, structure = 1, object = 2, dynamic = 3 };

// What light does at a surface: scattered back; mostly let through, with some mirrored; mirrored.
enum class Material : std::uint8_t { diffuse = 0, glass = 1, mirror = 2 };

// As files spell them: those that surfaces can have.
inline constexpr std::array<std::pair<std::string_view, SurfaceLabel>, 3> kLabelNames{{
    {"structure", SurfaceLabel::structure},
    {"object", SurfaceLabel::object},
    {"dynamic", SurfaceLabel::dynamic},
}};
inline constexpr std::array<std::pair<std::string_view, Material>, 3> kMaterialNames{{
    {"diffuse", Material::diffuse},
    {"glass", Material::glass},
    {"mirror", Material::mirror},
}};

}  // namespace convexcut::simulation
