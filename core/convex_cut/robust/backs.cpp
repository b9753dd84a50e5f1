// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/backs.hpp"

#include <cmath>

namespace convexcut::robust {
namespace {

constexpr float kNearestM = 0.10F;  // before the wall; nearer, voxels hold wall and floor at once
constexpr float kFarthestM = 0.40F;
constexpr float kOnSurfaceM = 0.06F;
constexpr std::int32_t kReach = 2;  // cells: the distance of shelves

[[nodiscard]] bool is_on_structure(const Model& model, const PlaneGrids& grids,
                                   const Vec3f& p) noexcept {
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Plane& plane = model.planes[k];
    if (plane.accepted && std::abs(plane.height_of(p)) < kOnSurfaceM &&
        grids.is_structure(k, p, 1)) {
      return true;
    }
  }
  return false;
}

void mark_before(const Model& model, PlaneGrids& grids, const Vec3f& p) noexcept {
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Plane& plane = model.planes[k];
    const float height = plane.height_of(p);
    if (!plane.accepted || !plane.vertical || height < kNearestM || height > kFarthestM) continue;
    const PlaneGrid& grid = grids.grid(k);
    const std::int32_t column = grid.column_of(p);
    const std::int32_t row = grid.row_of(p);
    if (grid.holds(column, row)) grids.cell(grid, column, row).before = true;
  }
}

[[nodiscard]] bool any_before(const PlaneGrids& grids, const PlaneGrid& grid, std::int32_t column,
                              std::int32_t first, std::int32_t end) noexcept {
  for (std::int32_t row = first; row < end; ++row) {
    if (grid.holds(column, row) && grids.cell(grid, column, row).before) return true;
  }
  return false;
}

}  // namespace

void mark_backs(const Model& model, PlaneGrids& grids) noexcept {
  for (const Surfel& surfel : model.surfels) {
    if (surfel.is_evidence() && !is_on_structure(model, grids, surfel.mean)) {
      mark_before(model, grids, surfel.mean);
    }
  }
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    if (!model.planes[k].accepted || !model.planes[k].vertical) continue;
    const PlaneGrid& grid = grids.grid(k);
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      for (std::int32_t column = 0; column < grid.columns; ++column) {
        Cell& cell = grids.cell(grid, column, row);
        cell.enclosed = cell.structure && any_before(grids, grid, column, row - kReach, row) &&
                        any_before(grids, grid, column, row + 1, row + 1 + kReach);
      }
    }
  }
}

}  // namespace convexcut::robust
