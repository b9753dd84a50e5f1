// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "replay/simulation/scene/fields.hpp"
#include "replay/simulation/scene/group_reader.hpp"
#include "replay/simulation/scene/movers.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {

// A mover of a scene file before its surfaces have numbers. The surface of a primitive is its index
// in `surfaces`.
struct MoverItem {
  std::vector<SurfaceInfo> surfaces;
  std::vector<Primitive> primitives;  // rigid ones; none: it is a person
  double person_height_m = 0.0;
  Mover mover;  // without its parts
  std::size_t line = 0;
};

// All of [[mover]], [[thrown]], [[person]] and [people] in the file.
[[nodiscard]] std::vector<MoverItem> read_movers(Fields& root, GroupReader& groups,
                                                 const SceneOptions& options);

// Way points are the key `path`, rows of two (at height z) or three numbers; nothing where they
// are missing or wrong, which is reported.
[[nodiscard]] Path read_path(Fields& fields, std::string_view key, std::size_t columns, double z);

}  // namespace convexcut::simulation
