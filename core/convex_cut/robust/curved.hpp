// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

// Structure that no plane explains: curved walls. What goes on smoothly from a wall, from voxel to
// voxel.
class Curved {
 public:
  explicit Curved(std::size_t max_surfels);

  // By surfel: 1 where it is structure.
  [[nodiscard]] std::span<const std::uint8_t> find(const Model& model, const PlaneGrids& grids,
                                                   const VoxelMap& map) noexcept;

 private:
  void take_seeds(const Model& model, const PlaneGrids& grids) noexcept;
  void grow(const Model& model, const VoxelMap& map) noexcept;

  std::vector<std::uint32_t> queue_;  // surfels
  std::vector<std::uint8_t> state_;   // by surfel
  std::vector<std::uint8_t> structure_;
};

}  // namespace convexcut::robust
