// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/flat_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace convexcut::robust {
namespace {

constexpr std::size_t kMostCellsOfAPart = 1U << 18U;
constexpr std::int32_t kReach = 2;  // cells: gaps within a part, and the ring around it
constexpr std::size_t kLeastCells = 6;
constexpr std::uint16_t kPassed = 2;      // one ray alone may be a ghost's
constexpr float kMostOpenRing = 0.25F;    // share of the ring that may be passed
constexpr float kMostOpenInside = 0.40F;  // and of the part itself
constexpr float kLevel = 0.97F;           // |z| of a normal
constexpr std::uint32_t kLargeSurfels = 30;

template <class Visit>
void for_each_within_reach(const PlaneGrid& grid, std::int32_t column, std::int32_t row,
                           Visit&& visit) noexcept {
  for (std::int32_t r = row - kReach; r <= row + kReach; ++r) {
    for (std::int32_t c = column - kReach; c <= column + kReach; ++c) {
      if (grid.holds(c, r)) visit(c, r);
    }
  }
}

}  // namespace

FlatSurfaces::FlatSurfaces() {
  part_.reserve(kMostCellsOfAPart);
  ring_.reserve(kMostCellsOfAPart);
}

void FlatSurfaces::find(Model& model, PlaneGrids& grids, const Vec3f& origin,
                        bool free_space) noexcept {
  model.floor_z = -std::numeric_limits<float>::infinity();
  model.ceiling_z = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    Plane& plane = model.planes[k];
    if (plane.vertical) continue;
    const PlaneGrid& grid = grids.grid(k);
    std::int16_t id = 0;
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      for (std::int32_t column = 0; column < grid.columns; ++column) {
        const Cell& cell = grids.cell(grid, column, row);
        if (cell.seen == 0 || cell.part >= 0) continue;
        collect_part(grids, grid, {column, row}, id);
        if (part_.size() >= kLeastCells && (!free_space || bounds_free_space(grids, grid, id))) {
          plane.accepted = true;
          for (const Place& p : part_) grids.cell(grid, p.column, p.row).structure = true;
        }
        ++id;
      }
    }
    if (!plane.accepted || std::abs(plane.normal.z()) < kLevel || plane.surfels < kLargeSurfels) {
      continue;
    }
    const float z = -plane.offset / plane.normal.z();
    if (z < origin.z() && (std::isinf(model.floor_z) || z < model.floor_z)) model.floor_z = z;
    if (z > origin.z() && (std::isinf(model.ceiling_z) || z > model.ceiling_z)) {
      model.ceiling_z = z;
    }
  }
}

void FlatSurfaces::collect_part(PlaneGrids& grids, const PlaneGrid& grid, Place seed,
                                std::int16_t id) noexcept {
  part_.clear();
  part_.push_back(seed);
  grids.cell(grid, seed.column, seed.row).part = id;
  for (std::size_t next = 0; next < part_.size(); ++next) {
    const Place at = part_[next];
    for_each_within_reach(grid, at.column, at.row, [&](std::int32_t c, std::int32_t r) {
      Cell& cell = grids.cell(grid, c, r);
      if (cell.seen == 0 || cell.part >= 0) return;
      cell.part = id;
      part_.push_back({c, r});
    });
  }
}

bool FlatSurfaces::bounds_free_space(PlaneGrids& grids, const PlaneGrid& grid,
                                     std::int16_t id) noexcept {
  ring_.clear();
  std::size_t open_inside = 0;
  std::size_t open_ring = 0;
  for (const Place& at : part_) {
    open_inside += grids.cell(grid, at.column, at.row).passed >= kPassed ? 1U : 0U;
    for_each_within_reach(grid, at.column, at.row, [&](std::int32_t c, std::int32_t r) {
      Cell& cell = grids.cell(grid, c, r);
      if (cell.part == id || cell.visited) return;
      cell.visited = true;
      ring_.push_back({c, r});
      open_ring += cell.passed >= kPassed ? 1U : 0U;
    });
  }
  for (const Place& at : ring_) grids.cell(grid, at.column, at.row).visited = false;
  return static_cast<float>(open_ring) < kMostOpenRing * static_cast<float>(ring_.size()) &&
         static_cast<float>(open_inside) < kMostOpenInside * static_cast<float>(part_.size());
}

}  // namespace convexcut::robust
