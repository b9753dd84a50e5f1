// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

// What lies flat on a wall or in a recess of it, nearer than a band can tell: pictures, boards,
// blinds, the backs of bookcases. The mean of a cell's points is known to millimetres, so connected
// cells that are off the wall's face together show a layer. One that stands on the floor like a
// door, or is as high as the room, is a part of the wall.
class Fixtures {
 public:
  Fixtures();

  // Sets the faces of the accepted vertical planes and the layers of their cells.
  void find(Model& model, PlaneGrids& grids) noexcept;

 private:
  struct Place {
    std::int32_t column, row;
  };
  void collect_layer(PlaneGrids& grids, const PlaneGrid& grid, float face_m, Place seed) noexcept;
  [[nodiscard]] bool is_in_front(const PlaneGrids& grids, const PlaneGrid& grid) const noexcept;
  [[nodiscard]] bool is_in_a_recess(const PlaneGrids& grids, const PlaneGrid& grid,
                                    float face_m) const noexcept;
  [[nodiscard]] bool is_of_the_wall(const Model& model, const Plane& plane,
                                    const PlaneGrid& grid) const noexcept;

  std::vector<Place> layer_;  // also the queue of the search for it
};

}  // namespace convexcut::robust
