// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/fixtures.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex_cut/robust/height_votes.hpp"
#include "core/convex_cut/robust/steps.hpp"

namespace convexcut::robust {
namespace {

constexpr std::size_t kMostCells = 1U << 16U;
constexpr float kProudM = 0.014F;         // the wall itself is flatter than this
constexpr float kProudOfGlassM = 0.017F;  // where it is partly glass: posts, frames, few points
constexpr float kAnyGlass = 0.01F;        // share of the cells
constexpr std::size_t kLeastCells = 3;
constexpr float kToFloorM = 0.4F;
constexpr float kHiddenM = 0.9F;  // over the floor: a door's foot, by a table or a chair
constexpr float kLeastDoorTopM = 1.7F;
constexpr float kMostDoorTopM = 2.4F;
constexpr float kDoorHeightM = 1.5F;
constexpr float kHalfDoorHeightM = 1.0F;   // of one whose foot is hidden
constexpr float kRoomHighM = 2.2F;         // a layer as high as that is a part of the wall
constexpr float kLeastHeadM = 1.7F;        // over the floor: of doors and windows
constexpr float kLeastWallShare = 0.125F;  // of the cells seen of it
constexpr float kLeastGlass = 0.2F;        // share of a layer's cells that rays go through
constexpr float kLeastGlassOfFace = 0.1F;  // the same of a face's
constexpr std::int32_t kLeastDoorColumns = 2;
constexpr std::int32_t kMostDoorColumns = 5;
constexpr float kSolid = 0.7F;  // share of its columns that a door covers

// Of the cells that tell a wall's depth. What is seen above a hole may be a blind.
template <class Visit>
void for_each_face_cell(const PlaneGrids& grids, const PlaneGrid& grid, Visit&& visit) noexcept {
  for (std::int32_t column = 0; column < grid.columns; ++column) {
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      const Cell& cell = grids.cell(grid, column, row);
      if (cell.is_hole()) break;
      if (cell.structure && cell.tells_depth()) visit(cell);
    }
  }
}

// The height over the plane that most cells have: the mean of these.
[[nodiscard]] float face_of(const PlaneGrids& grids, const PlaneGrid& grid) noexcept {
  HeightVotes votes;
  for_each_face_cell(grids, grid, [&](const Cell& cell) { votes.add(cell.mean_m()); });
  const float middle_m = votes.mode().height_m;
  float sum_m = 0.0F;
  std::int32_t cells = 0;
  for_each_face_cell(grids, grid, [&](const Cell& cell) {
    if (std::abs(cell.mean_m() - middle_m) > HeightVotes::kWithinM) return;
    sum_m += cell.mean_m();
    ++cells;
  });
  return cells > 0 ? sum_m / static_cast<float>(cells) : middle_m;
}

// Of the cells of a wall that tell its depth and that a test is true of: how many rays go through.
template <class Test>
[[nodiscard]] float passed_share(const PlaneGrids& grids, const PlaneGrid& grid,
                                 Test&& is_asked) noexcept {
  std::size_t cells = 0;
  std::size_t passed = 0;
  grids.for_each_cell(grid, [&](const Cell& cell) {
    if (!cell.structure || !cell.tells_depth() || !is_asked(cell)) return;
    ++cells;
    passed += cell.passed >= kPassed ? 1U : 0U;
  });
  return static_cast<float>(passed) / static_cast<float>(std::max<std::size_t>(cells, 1));
}

[[nodiscard]] bool has_glass(const PlaneGrids& grids, const PlaneGrid& grid) noexcept {
  return passed_share(grids, grid, [](const Cell&) { return true; }) > kAnyGlass;
}

[[nodiscard]] bool is_off(const Cell& cell, const WallFace& face) noexcept {
  return cell.structure && !cell.visited && cell.tells_depth() && !face.holds(cell.mean_m());
}

// Whether rays go through the face: what is proud of it is its frame.
[[nodiscard]] bool is_glazed(const PlaneGrids& grids, const PlaneGrid& grid,
                             const WallFace& face) noexcept {
  return passed_share(grids, grid, [&](const Cell& cell) { return face.holds(cell.mean_m()); }) >
         kLeastGlassOfFace;
}

void be_wall(Cell& cell) noexcept {
  cell.inset_m = cell.layer_m;
  cell.layer_m = 0.0F;
}

// Where wall, or a hole under it, is seen in line with a cell of a layer.
struct Surroundings {
  bool above = false, below = false, left = false, right = false;
  bool hole = false;
  std::int32_t head = 0;  // where above: the lowest row of it
};

[[nodiscard]] Surroundings surroundings_of(const PlaneGrids& grids, const PlaneGrid& grid,
                                           const WallFace& face, std::int32_t at_column,
                                           std::int32_t at_row) noexcept {
  const auto is_face = [&](std::int32_t column, std::int32_t row) {
    const Cell& cell = grids.cell(grid, column, row);
    return cell.structure && cell.layer_m == 0.0F && cell.tells_depth() &&
           face.holds(cell.mean_m());
  };
  Surroundings around;
  for (std::int32_t row = at_row + 1; row < grid.rows; ++row) {
    const Cell& cell = grids.cell(grid, at_column, row);
    if (around.above || !cell.structure || cell.layer_m != 0.0F) continue;
    around.above = true;
    around.head = row;
  }
  for (std::int32_t row = 0; row < at_row; ++row) {
    around.below = around.below || is_face(at_column, row);
    around.hole = around.hole || grids.cell(grid, at_column, row).is_hole();
  }
  for (std::int32_t c = 0; c < at_column; ++c) around.left = around.left || is_face(c, at_row);
  for (std::int32_t c = at_column + 1; c < grid.columns; ++c) {
    around.right = around.right || is_face(c, at_row);
  }
  return around;
}

}  // namespace

Fixtures::Fixtures() { layer_.reserve(kMostCells); }

void Fixtures::find(Model& model, PlaneGrids& grids) noexcept {
  set_stepped_walls_upright(model, grids);
  faces_.lay(model, grids);
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    Plane& plane = model.planes[k];
    const bool has_face = plane.stepped || plane.surfels >= kLargeFaceSurfels;
    if (!plane.accepted || !plane.vertical || !has_face) continue;
    const PlaneGrid& grid = grids.grid(k);
    WallFace face{face_of(grids, grid), has_glass(grids, grid) ? kProudOfGlassM : kProudM};
    face.height_m = wall_behind(model, grids, k, face).value_or(face.height_m);
    plane.face_m = face.height_m;
    const bool glazed = is_glazed(grids, grid, face);
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      for (std::int32_t column = 0; column < grid.columns; ++column) {
        if (!is_off(grids.cell(grid, column, row), face)) continue;
        collect_layer(grids, grid, face, {column, row});
        leave_out_doors(model, grids, k, face);
        if (layer_.size() >= kLeastCells && !is_glass(grids, grid) &&
            (is_in_front(grids, grid) ? !glazed : is_in_a_recess(grids, grid, face))) {
          continue;
        }
        for (const Place& at : layer_) be_wall(grids.cell(grid, at.column, at.row));
      }
    }
  }
}

void Fixtures::collect_layer(PlaneGrids& grids, const PlaneGrid& grid, const WallFace& face,
                             Place seed) noexcept {
  layer_.clear();
  const auto take = [&](std::int32_t column, std::int32_t row) {
    Cell& cell = grids.cell(grid, column, row);
    cell.visited = true;
    cell.layer_m = cell.mean_m() - face.height_m;
    layer_.push_back({column, row});
  };
  take(seed.column, seed.row);
  const float sign = grids.cell(grid, seed.column, seed.row).layer_m;
  // NOLINTNEXTLINE(modernize-loop-convert): the layer grows meanwhile.
  for (std::size_t next = 0; next < layer_.size(); ++next) {
    const Place at = layer_[next];
    for (std::int32_t row = at.row - 1; row <= at.row + 1; ++row) {
      for (std::int32_t column = at.column - 1; column <= at.column + 1; ++column) {
        if (!grid.holds(column, row) || layer_.size() == kMostCells) continue;
        const Cell& cell = grids.cell(grid, column, row);
        if (is_off(cell, face) && (cell.mean_m() - face.height_m) * sign > 0.0F) take(column, row);
      }
    }
  }
}

bool Fixtures::is_in_front(const PlaneGrids& grids, const PlaneGrid& grid) const noexcept {
  return grids.cell(grid, layer_.front().column, layer_.front().row).layer_m > 0.0F;
}

// Rays go through a pane where they do not return from it.
bool Fixtures::is_glass(const PlaneGrids& grids, const PlaneGrid& grid) const noexcept {
  const auto passed = std::count_if(layer_.begin(), layer_.end(), [&](const Place& at) {
    return grids.cell(grid, at.column, at.row).passed >= kPassed;
  });
  return static_cast<float>(passed) > kLeastGlass * static_cast<float>(layer_.size());
}

// What lies behind the face is a blind in a window when wall is seen above most of it, when it
// hangs over a hole, or when wall frames it on three sides; otherwise it is the wall, and what
// stands before it was taken for the face.
bool Fixtures::is_in_a_recess(const PlaneGrids& grids, const PlaneGrid& grid,
                              const WallFace& face) const noexcept {
  std::size_t hanging = 0;
  std::size_t framed = 0;
  for (const Place& at : layer_) {
    const Surroundings around = surroundings_of(grids, grid, face, at.column, at.row);
    hanging += around.above || around.hole ? 1U : 0U;
    framed += around.below && around.left && around.right ? 1U : 0U;
  }
  return 2 * hanging > layer_.size() || 2 * framed > layer_.size();
}

// A board may have more cells than what is seen of its wall, and is taken for the face then.
std::optional<float> Fixtures::wall_behind(const Model& model, PlaneGrids& grids, std::size_t plane,
                                           const WallFace& face) noexcept {
  const PlaneGrid& grid = grids.grid(plane);
  std::optional<float> found;
  bool any = false;
  std::size_t seen = 0;
  grids.for_each_cell(grid, [&](const Cell& cell) {
    seen += cell.structure && !cell.enclosed && cell.tells_depth() ? 1U : 0U;
  });
  for (std::int32_t row = 0; row < grid.rows && !found; ++row) {
    for (std::int32_t column = 0; column < grid.columns && !found; ++column) {
      const Cell& cell = grids.cell(grid, column, row);
      if (!is_off(cell, face) || cell.mean_m() > face.height_m) continue;
      collect_layer(grids, grid, face, {column, row});
      any = true;
      if (static_cast<float>(layer_.size()) < kLeastWallShare * static_cast<float>(seen) ||
          !goes_on_below(model, grids, plane, face)) {
        continue;
      }
      float sum_m = 0.0F;
      for (const Place& at : layer_) sum_m += grids.cell(grid, at.column, at.row).layer_m;
      found = face.height_m + sum_m / static_cast<float>(layer_.size());
    }
  }
  if (!any) return std::nullopt;
  grids.for_each_cell(grid, [](Cell& cell) {
    cell.visited = false;
    cell.layer_m = 0.0F;
  });
  return found;
}

// Whether most of the layer is below the face, which ends lower than the head of any opening: so
// it is the face that hangs on the layer, a board on a wall.
bool Fixtures::goes_on_below(const Model& model, const PlaneGrids& grids, std::size_t plane,
                             const WallFace& face) const noexcept {
  const Plane& wall = model.planes[plane];
  const PlaneGrid& grid = grids.grid(plane);
  const auto height_m = [&](std::int32_t column, std::int32_t row) {
    return grid.centre(wall, column, row).z() - model.floor_z;
  };
  std::size_t cells = 0;
  std::size_t below = 0;
  std::int32_t lowest = grid.rows;
  std::int32_t highest = 0;
  for (const Place& at : layer_) {
    if (height_m(at.column, at.row) < kFloorReachM) continue;
    ++cells;
    lowest = std::min(lowest, at.row);
    highest = std::max(highest, at.row);
    const Surroundings around = surroundings_of(grids, grid, face, at.column, at.row);
    const bool is_below =
        around.above && !around.hole && height_m(at.column, around.head) < kLeastHeadM;
    below += is_below ? 1U : 0U;
  }
  return highest > lowest && below >= kLeastCells && 2 * below > cells;
}

// Column by column: a board beside a door, a cell away, is in the same layer.
void Fixtures::leave_out_doors(const Model& model, PlaneGrids& grids, std::size_t plane,
                               const WallFace& face) noexcept {
  if (std::isinf(model.floor_z)) return;
  const PlaneGrid& grid = grids.grid(plane);
  std::sort(layer_.begin(), layer_.end(), [](const Place& a, const Place& b) {
    return a.column < b.column || (a.column == b.column && a.row < b.row);
  });
  const auto end_of_column = [&](std::size_t first) {
    std::size_t end = first;
    while (end < layer_.size() && layer_[end].column == layer_[first].column) ++end;
    return end;
  };
  std::size_t kept = 0;
  for (std::size_t first = 0; first < layer_.size();) {
    std::size_t end = first;
    std::int32_t doors = 0;
    bool any_wall = false;
    while (end < layer_.size() &&
           (end == first || layer_[end].column == layer_[end - 1].column + 1)) {
      const Upright upright = upright_of(model, grids, plane, face, end, end_of_column(end));
      if (upright == Upright::none) break;
      doors += upright == Upright::door ? 1 : 0;
      any_wall = any_wall || upright == Upright::wall;
      end = end_of_column(end);
    }
    if (end == first) end = end_of_column(first);
    const bool of_the_wall = (any_wall || doors >= kLeastDoorColumns) && doors <= kMostDoorColumns;
    for (; first < end; ++first) {
      const Place at = layer_[first];
      if (of_the_wall) be_wall(grids.cell(grid, at.column, at.row));
      if (!of_the_wall) layer_[kept++] = at;
    }
  }
  layer_.resize(kept);
}

// Of one column of the layer.
Fixtures::Upright Fixtures::upright_of(const Model& model, const PlaneGrids& grids,
                                       std::size_t plane, const WallFace& face, std::size_t first,
                                       std::size_t end) const noexcept {
  const PlaneGrid& grid = grids.grid(plane);
  const Place low = layer_[first];
  const std::int32_t high = layer_[end - 1].row;
  const float bottom_m =
      grid.centre(model.planes[plane], low.column, low.row).z() - kCellM / 2 - model.floor_z;
  const float height_m = static_cast<float>(high - low.row + 1) * kCellM;
  const float top_m = bottom_m + height_m;
  if (static_cast<float>(end - first) * kCellM < kSolid * height_m) return Upright::none;
  if (bottom_m <= kToFloorM && height_m >= kRoomHighM) return Upright::wall;
  if (bottom_m <= kToFloorM) return height_m >= kDoorHeightM ? Upright::door : Upright::none;
  const Surroundings around = surroundings_of(grids, grid, face, low.column, low.row);
  const bool is_door = bottom_m <= kHiddenM && !around.below && !around.hole &&
                       height_m >= kHalfDoorHeightM && top_m >= kLeastDoorTopM &&
                       top_m <= kMostDoorTopM;
  return is_door ? Upright::door : Upright::none;
}

}  // namespace convexcut::robust
