// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/steps.hpp"

#include <cstddef>
#include <cstdint>

#include "core/convex_cut/robust/plane_search.hpp"

namespace convexcut::robust {
namespace {

constexpr float kLeastLean = 0.006F;  // slope: 2 cm in three metres
constexpr float kMostLean = 0.05F;
constexpr float kLeastStepM = 0.02F;
constexpr std::int32_t kLeastCells = 3;  // of each part
constexpr float kBetter = 0.6F;          // sum of squares, of that about the leaning plane

// Of heights.
struct Sums {
  std::int32_t count = 0;
  float sum_m = 0.0F;
  float squares_m2 = 0.0F;

  void add(float height_m) noexcept {
    ++count;
    sum_m += height_m;
    squares_m2 += height_m * height_m;
  }
  [[nodiscard]] float mean_m() const noexcept { return sum_m / static_cast<float>(count); }
  [[nodiscard]] float about_mean_m2() const noexcept { return squares_m2 - sum_m * mean_m(); }
};
[[nodiscard]] Sums operator-(const Sums& a, const Sums& b) noexcept {
  return {a.count - b.count, a.sum_m - b.sum_m, a.squares_m2 - b.squares_m2};
}

// Of the cells of a row that tell how deep the wall is: over the plane, when that leans by so much
// less.
void add_row(const PlaneGrids& grids, const PlaneGrid& grid, std::int32_t row, float lean,
             Sums& sums) noexcept {
  const float up_m = static_cast<float>(row) * kCellM;
  for (std::int32_t column = 0; column < grid.columns; ++column) {
    const Cell& cell = grids.cell(grid, column, row);
    if (!cell.structure || cell.enclosed || cell.passed > 0 || !cell.tells_depth()) continue;
    sums.add(cell.mean_m() - lean * up_m);
  }
}

[[nodiscard]] bool has_step(const PlaneGrids& grids, const PlaneGrid& grid, std::int32_t first,
                            float lean) noexcept {
  Sums leaning;
  Sums upright;
  for (std::int32_t row = first; row < grid.rows; ++row) {
    add_row(grids, grid, row, 0.0F, leaning);
    add_row(grids, grid, row, lean, upright);
  }
  Sums lower;
  for (std::int32_t row = first; row < grid.rows; ++row) {
    add_row(grids, grid, row, lean, lower);
    const Sums upper = upright - lower;
    if (lower.count < kLeastCells || upper.count < kLeastCells) continue;
    if (upper.mean_m() - lower.mean_m() < kLeastStepM) continue;
    if (lower.about_mean_m2() + upper.about_mean_m2() < kBetter * leaning.about_mean_m2()) {
      return true;
    }
  }
  return false;
}

}  // namespace

void set_stepped_walls_upright(Model& model, PlaneGrids& grids) noexcept {
  const Vec3f up = up_of(model);
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    Plane& plane = model.planes[k];
    if (!plane.accepted || !plane.vertical) continue;
    const float lean = plane.normal.dot(up);  // negative: its top is nearer
    if (lean > -kLeastLean || lean < -kMostLean) continue;
    const PlaneGrid& grid = grids.grid(k);
    std::int32_t first = 0;
    while (grid.centre(plane, 0, first).z() < model.floor_z + kFloorReachM) ++first;
    if (!has_step(grids, grid, first, lean)) continue;
    grids.turn(plane, grid, grid.centre(plane, grid.columns / 2, grid.rows / 2), 0.0F, lean);
    plane.stepped = true;
  }
}

}  // namespace convexcut::robust
