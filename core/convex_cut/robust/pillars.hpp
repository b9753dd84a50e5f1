// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/moments.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/ray_kernels.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

// Pillars and columns by their footprint, since planes cover only a part of a round one, and voxels
// at the edges of a narrow one have no normal: compact, as thin as a surface at all heights
// together, and standing free, or at a wall that is seen on both sides of it or well behind it.
// Nothing passes through it, nor over it as far as the view reaches.
class Pillars {
 public:
  explicit Pillars(std::size_t max_surfels);

  // By surfel: 1 where it is of a pillar, up to 25 m away. origin: the lidar's.
  [[nodiscard]] std::span<const std::uint8_t> find(const Model& model, const PlaneGrids& grids,
                                                   const VoxelMap& map,
                                                   const Vec3f& origin) noexcept;

 private:
  // Sums over what is seen from above.
  struct Spread {
    float weight = 0.0F;
    Eigen::Vector2f sum_m = Eigen::Vector2f::Zero();
    Eigen::Matrix2f products_m2 = Eigen::Matrix2f::Zero();

    void add(const Moments& points) noexcept;
    // As if it had that weight, and from an origin that it is moved against.
    void add(const Spread& other, float as_weight, const Eigen::Vector2f& moved_m) noexcept;
    [[nodiscard]] Eigen::Vector2f mean_m() const noexcept { return sum_m / weight; }
    // Along its axes, the least first.
    [[nodiscard]] Eigen::Vector2f variances_m2() const noexcept;
  };
  // The voxels above each other.
  struct Column {
    std::int32_t x = 0, y = 0;  // on the grid
    std::uint64_t levels = 0;   // where something was seen that is neither flat nor a wall
    Spread spread;              // of its points, from the column's middle
    bool wall = false;
    bool taken = false;
    bool pillar = false;
  };
  // Tall columns that touch.
  struct Footprint {
    Eigen::Vector2f mean_m;                     // in the model's frame
    std::int32_t width = 0;                     // columns
    std::int32_t bottom = 0, height = 0;        // levels
    float filled = 0.0F;                        // share of its voxels that was seen
    float thickness2 = 0.0F;                    // m², of a column, the mean by points
    float shortest_m = 0.0F, longest_m = 0.0F;  // across
  };

  void take_columns(const Model& model, const PlaneGrids& grids, const VoxelMap& map) noexcept;
  [[nodiscard]] std::uint16_t add_voxel(const Voxel& voxel, bool supported, bool wall) noexcept;
  void take_members(std::size_t seed) noexcept;
  [[nodiscard]] Footprint footprint_of_members() const noexcept;
  [[nodiscard]] bool stands_free(const Rays& rays, const Footprint& footprint,
                                 const Vec3f& origin) noexcept;

  Lattice corner_{};                 // of the grid, on its lowest level
  std::vector<std::uint16_t> grid_;  // a column's index and 1; 0: none
  std::vector<Column> columns_;
  std::vector<std::uint16_t> members_;           // columns of the footprint at hand
  bool at_wall_ = false;                         // one of them touches a wall
  std::vector<std::uint16_t> column_of_surfel_;  // as in grid_
  std::vector<std::uint8_t> structure_;
  Passages passages_;
};

}  // namespace convexcut::robust
