// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut::simulation {

// What a surface is, in the sense of the paper: structure stays when the room is cleared, objects
// can be moved, dynamic ones move by themselves. `none` is what no surface has: a ray into nothing.
// The numbers are those of the truth files.
enum class SurfaceLabel : std::uint8_t { none = 0, structure = 1, object = 2, dynamic = 3 };

// What light does at a surface: scattered back; mostly let through, with some mirrored; mirrored.
enum class Material : std::uint8_t { diffuse = 0, glass = 1, mirror = 2 };

}  // namespace convexcut::simulation
