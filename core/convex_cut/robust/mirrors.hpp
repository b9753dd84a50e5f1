// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

// Mirror images: what is seen through a hole in a wall and, reflected at the wall, lies on surfaces
// that are seen before it. Surfaces across the wall (floor, side walls) are their own images and
// tell nothing; those along it do.
class Mirrors {
 public:
  explicit Mirrors(std::size_t max_surfels);

  // Marks the surfels that are images; whether there are any.
  [[nodiscard]] bool find(Model& model, const PlaneGrids& grids, const VoxelMap& map) noexcept;

 private:
  // A surfel behind a wall and the cell that it is seen through.
  struct Sight {
    std::uint32_t cell = 0;
    std::uint32_t surfel = 0;
  };
  void collect_sights(const Model& model, const PlaneGrids& grids, std::size_t plane) noexcept;
  void collect_hole(const PlaneGrid& grid, std::uint32_t seed) noexcept;
  [[nodiscard]] bool is_framed(const PlaneGrids& grids, const PlaneGrid& grid) noexcept;
  [[nodiscard]] bool is_image(const Model& model, const VoxelMap& map, const Plane& plane) noexcept;
  [[nodiscard]] bool is_contradicted(const Model& model, const Rays& rays, const VoxelMap& map,
                                     const Plane& plane) noexcept;

  std::vector<Sight> sights_;  // by cell
  std::vector<Sight> unsorted_;
  std::vector<std::uint32_t> starts_;       // of each cell in sights_, and the end
  std::vector<std::uint32_t> hole_;         // cells; also the queue of the search for them
  std::vector<std::uint32_t> informative_;  // of a hole, the surfels that can tell an image
  std::vector<std::uint32_t> unmatched_;    // of a hole, those that have no counterpart
  std::vector<std::uint8_t> visited_;       // by cell
};

}  // namespace convexcut::robust
