// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/backs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/convex_cut/robust/point_kernels.hpp"
#include "core/convex_cut/robust/ray_kernels.hpp"

namespace convexcut::robust {
namespace {

constexpr float kNearestM = 0.10F;  // before the wall; nearer, voxels hold wall and floor at once
constexpr float kFarthestM = 0.40F;
constexpr float kOnSurfaceM = 0.06F;
constexpr std::int32_t kReach = 2;  // cells: the distance of shelves
// Of the eight cells around.
constexpr int kMostlyHidden = 6;
constexpr int kLeastBetween = 3;
constexpr std::uint32_t kLargePlane = 112;  // surfels

// near: the planes that the surfel is near. Most lie on structure of their own plane.
[[nodiscard]] bool is_on_structure(const Model& model, const PlaneGrids& grids, std::size_t surfel,
                                   std::uint64_t near) noexcept {
  const Vec3f& p = model.surfels[surfel].mean;
  const std::int32_t own = model.surfels[surfel].plane;
  if (own != kNoPlane && grids.is_on_structure(surfel) &&
      std::abs(model.planes[static_cast<std::size_t>(own)].height_of(p)) < kOnSurfaceM) {
    return true;
  }
  for (; near != 0; near &= near - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(near));
    if (std::abs(model.planes[k].height_of(p)) < kOnSurfaceM && grids.is_structure(k, p, 1)) {
      return true;
    }
  }
  return false;
}

[[nodiscard]] Cell* cell_at(PlaneGrids& grids, std::size_t plane, const Vec3f& p) noexcept {
  const PlaneGrid& grid = grids.grid(plane);
  const std::int32_t column = grid.column_of(p);
  const std::int32_t row = grid.row_of(p);
  return grid.holds(column, row) ? &grids.cell(grid, column, row) : nullptr;
}

// The cell square behind p, and the one that p hides from where it was seen.
void mark_before(const Model& model, PlaneGrids& grids, const Surfel& surfel,
                 std::uint64_t near) noexcept {
  const Vec3f& p = surfel.mean;
  for (; near != 0; near &= near - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(near));
    const Plane& plane = model.planes[k];
    const float height = plane.height_of(p);
    if (!plane.vertical || height < kNearestM || height > kFarthestM) continue;
    if (Cell* cell = cell_at(grids, k, p)) cell->before = true;
    const float from = plane.height_of(surfel.origin);
    if (from < height + kNearestM) continue;
    const Vec3f hidden = surfel.origin + (p - surfel.origin) * (from / (from - height));
    if (Cell* cell = cell_at(grids, k, hidden)) cell->hidden = true;
  }
}

// Whether cells within reach above and below are so.
[[nodiscard]] bool is_between(const PlaneGrids& grids, const PlaneGrid& grid, std::int32_t column,
                              std::int32_t row, bool Cell::*so) noexcept {
  const auto any = [&](std::int32_t first, std::int32_t end) {
    for (std::int32_t r = first; r < end; ++r) {
      if (grid.holds(column, r) && grids.cell(grid, column, r).*so) return true;
    }
    return false;
  };
  return any(row - kReach, row) && any(row + 1, row + 1 + kReach);
}

// Of the eight cells around.
[[nodiscard]] int count_around(const PlaneGrids& grids, const PlaneGrid& grid, std::int32_t column,
                               std::int32_t row, bool Cell::*so) noexcept {
  int count = 0;
  for (std::int32_t r = row - 1; r <= row + 1; ++r) {
    for (std::int32_t c = column - 1; c <= column + 1; ++c) {
      if ((r != row || c != column) && grid.holds(c, r) && grids.cell(grid, c, r).*so) ++count;
    }
  }
  return count;
}

// A wall that was seen past the end of a bookcase has things square before it as well.
[[nodiscard]] bool is_between_boards(const PlaneGrids& grids, const PlaneGrid& grid,
                                     std::int32_t column, std::int32_t row) noexcept {
  return is_between(grids, grid, column, row, &Cell::before) &&
         (!grids.cell(grid, column, row).structure ||
          is_between(grids, grid, column, row, &Cell::hidden));
}

// One cell alone that is between things may be a wall beside a lamp or a person; in small planes
// there is not much else.
[[nodiscard]] bool is_enclosed(const PlaneGrids& grids, const Plane& plane, const PlaneGrid& grid,
                               std::int32_t column, std::int32_t row) noexcept {
  const Cell& cell = grids.cell(grid, column, row);
  const bool mostly_hidden = count_around(grids, grid, column, row, &Cell::hidden) >= kMostlyHidden;
  if (mostly_hidden && cell.before && cell.hidden) return true;
  return cell.between && (mostly_hidden || plane.surfels < kLargePlane ||
                          count_around(grids, grid, column, row, &Cell::between) >= kLeastBetween);
}

template <class Visit>
void for_each_cell_of_walls(const Model& model, PlaneGrids& grids, Visit&& visit) noexcept {
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    if (!model.planes[k].accepted || !model.planes[k].vertical) continue;
    const PlaneGrid& grid = grids.grid(k);
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      for (std::int32_t column = 0; column < grid.columns; ++column) {
        visit(model.planes[k], grid, column, row);
      }
    }
  }
}

}  // namespace

void mark_backs(const Model& model, PlaneGrids& grids) noexcept {
  const Rays& rays = grids.rays();
  const std::uint64_t accepted = accepted_planes(model.planes);
  PlaneSets near;
  for (std::size_t begin = 0; begin < rays.size(); begin += kPointsAtOnce) {
    find_planes({rays.column(3) + begin, rays.column(4) + begin, rays.column(5) + begin},
                model.planes, accepted, kFarthestM, near);
    for (std::size_t i = 0; i < std::min(kPointsAtOnce, rays.size() - begin); ++i) {
      const std::uint32_t surfel = rays.surfel(begin + i);
      if (near[i] != 0 && !is_on_structure(model, grids, surfel, near[i])) {
        mark_before(model, grids, model.surfels[surfel], near[i]);
      }
    }
  }
  for_each_cell_of_walls(
      model, grids,
      [&](const Plane&, const PlaneGrid& grid, std::int32_t column, std::int32_t row) {
        grids.cell(grid, column, row).between = is_between_boards(grids, grid, column, row);
      });
  for_each_cell_of_walls(
      model, grids,
      [&](const Plane& plane, const PlaneGrid& grid, std::int32_t column, std::int32_t row) {
        grids.cell(grid, column, row).enclosed = is_enclosed(grids, plane, grid, column, row);
      });
}

}  // namespace convexcut::robust
