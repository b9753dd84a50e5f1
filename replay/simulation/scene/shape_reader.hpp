// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "replay/simulation/scene/fields.hpp"
#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/scene/shapes.hpp"

namespace convexcut::simulation {

// A surface of a scene file: shapes that share a name and a look.
struct Item {
  SurfaceInfo info;
  std::vector<Shape> shapes;
  std::size_t line = 0;  // for messages
};

// name, label, reflectivity and material; `otherwise` holds what is not said.
[[nodiscard]] SurfaceInfo read_surface(Fields& fields, SurfaceInfo otherwise);

// What a table [[kind]] may be: "box", "cylinder", …
inline constexpr std::array<std::string_view, 6> kShapeKinds{"box",       "cylinder", "sphere",
                                                             "rectangle", "polygon",  "mesh"};

// One [[kind]] table, whole; nothing where something is wrong, which is reported. Mesh files are
// looked for in `directory`.
[[nodiscard]] std::vector<Item> read_shape(std::string_view kind, Fields fields,
                                           std::string_view default_name,
                                           const std::filesystem::path& directory);

// One [[room]] table: floor, ceiling, walls, and the panes in their openings.
[[nodiscard]] std::vector<Item> read_room(Fields fields, std::string_view default_name);

}  // namespace convexcut::simulation
