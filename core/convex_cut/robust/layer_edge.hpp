// SPDX-License-Identifier: Apache-2.0
//
// Which points of a voxel on a layer of a wall (a board, a picture), or beside one, lie on it. A
// voxel may hold the layer's edge: then the height over the wall changes from one side of it to the
// other, and is taken for a linear function of the place.
#pragma once

#include <cstddef>
#include <optional>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"
#include "core/geometry.hpp"

namespace convexcut::robust {

class LayerEdge {
 public:
  // Of a voxel of the map that the model knows, on an upright plane; none where no layer of the
  // plane is near. RT.
  [[nodiscard]] static std::optional<LayerEdge> of(const Model& model, const PlaneGrids& grids,
                                                   const VoxelMap& map, std::size_t voxel,
                                                   std::size_t plane) noexcept;

  [[nodiscard]] bool is_on_layer(const Vec3f& p) const noexcept {
    return slope_.dot(p) + beyond_m_ > 0.0F;
  }

 private:
  // Of what the points' expected height has beyond half of the layer's.
  Vec3f slope_ = Vec3f::Zero();
  float beyond_m_ = 0.0F;
};

}  // namespace convexcut::robust
