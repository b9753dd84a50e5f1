// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/fixtures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace convexcut::robust {
namespace {

constexpr std::size_t kMostCells = 1U << 16U;
constexpr std::int32_t kLeastPoints = 20;  // of a cell, for a mean to half a centimetre
constexpr float kOffM = 0.017F;            // the wall itself is flatter than this
constexpr std::size_t kLeastCells = 3;
constexpr std::uint16_t kPassed = 2;         // one ray alone may be a ghost's
constexpr std::uint32_t kLargeSurfels = 60;  // of a wall; smaller ones have no sure face
constexpr float kBinM = 0.004F;
constexpr std::size_t kBins = 41;  // ±8 cm
constexpr std::size_t kMiddleBin = kBins / 2;
constexpr float kToFloorM = 0.4F;
constexpr float kDoorHeightM = 1.5F;
constexpr float kRoomHighM = 2.2F;  // a layer as high as that is a part of the wall
constexpr float kLeastDoorM = 0.5F;
constexpr float kMostDoorM = 1.3F;
constexpr float kSolid = 0.7F;  // share of its rectangle that a door covers

// Whether rays go through the plane there.
[[nodiscard]] bool is_hole(const Cell& cell) noexcept {
  return cell.seen == 0 && cell.passed >= kPassed;
}

// The height over the plane that most cells have. What is seen above a hole may be a blind.
[[nodiscard]] float face_of(const PlaneGrids& grids, const PlaneGrid& grid) noexcept {
  std::array<std::int32_t, kBins> cells{};
  for (std::int32_t column = 0; column < grid.columns; ++column) {
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      const Cell& cell = grids.cell(grid, column, row);
      if (is_hole(cell)) break;
      if (!cell.structure || cell.points < kLeastPoints) continue;
      const auto bin = static_cast<std::ptrdiff_t>(std::lround(cell.mean_m() / kBinM)) +
                       static_cast<std::ptrdiff_t>(kMiddleBin);
      if (bin > 0 && bin < static_cast<std::ptrdiff_t>(kBins) - 1) {
        ++cells.at(static_cast<std::size_t>(bin));
      }
    }
  }
  std::size_t best = kMiddleBin;
  std::int32_t most = 0;
  for (std::size_t bin = 1; bin + 1 < kBins; ++bin) {
    const std::int32_t around = cells.at(bin - 1) + 2 * cells.at(bin) + cells.at(bin + 1);
    if (around <= most) continue;
    most = around;
    best = bin;
  }
  return (static_cast<float>(best) - static_cast<float>(kMiddleBin)) * kBinM;
}

[[nodiscard]] bool is_off(const Cell& cell, float face_m) noexcept {
  return cell.structure && !cell.visited && cell.points >= kLeastPoints &&
         std::abs(cell.mean_m() - face_m) > kOffM;
}

// Where wall, or a hole under it, is seen in line with a cell of a layer.
struct Surroundings {
  bool above = false, below = false, left = false, right = false;
  bool hole = false;
};

[[nodiscard]] Surroundings surroundings_of(const PlaneGrids& grids, const PlaneGrid& grid,
                                           float face_m, std::int32_t at_column,
                                           std::int32_t at_row) noexcept {
  const auto is_face = [&](std::int32_t column, std::int32_t row) {
    const Cell& cell = grids.cell(grid, column, row);
    return cell.structure && cell.layer_m == 0.0F && cell.points >= kLeastPoints &&
           std::abs(cell.mean_m() - face_m) <= kOffM;
  };
  Surroundings around;
  for (std::int32_t row = at_row + 1; row < grid.rows; ++row) {
    const Cell& cell = grids.cell(grid, at_column, row);
    around.above = around.above || (cell.structure && cell.layer_m == 0.0F);
  }
  for (std::int32_t row = 0; row < at_row; ++row) {
    around.below = around.below || is_face(at_column, row);
    around.hole = around.hole || is_hole(grids.cell(grid, at_column, row));
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
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    Plane& plane = model.planes[k];
    if (!plane.accepted || !plane.vertical || plane.surfels < kLargeSurfels) continue;
    const PlaneGrid& grid = grids.grid(k);
    plane.face_m = face_of(grids, grid);
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      for (std::int32_t column = 0; column < grid.columns; ++column) {
        if (!is_off(grids.cell(grid, column, row), plane.face_m)) continue;
        collect_layer(grids, grid, plane.face_m, {column, row});
        if (layer_.size() >= kLeastCells && !is_of_the_wall(model, plane, grid) &&
            (is_in_front(grids, grid) || is_in_a_recess(grids, grid, plane.face_m))) {
          continue;
        }
        for (const Place& at : layer_) grids.cell(grid, at.column, at.row).layer_m = 0.0F;
      }
    }
  }
}

void Fixtures::collect_layer(PlaneGrids& grids, const PlaneGrid& grid, float face_m,
                             Place seed) noexcept {
  layer_.clear();
  const auto take = [&](std::int32_t column, std::int32_t row) {
    Cell& cell = grids.cell(grid, column, row);
    cell.visited = true;
    cell.layer_m = cell.mean_m() - face_m;
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
        if (is_off(cell, face_m) && (cell.mean_m() - face_m) * sign > 0.0F) take(column, row);
      }
    }
  }
}

bool Fixtures::is_in_front(const PlaneGrids& grids, const PlaneGrid& grid) const noexcept {
  return grids.cell(grid, layer_.front().column, layer_.front().row).layer_m > 0.0F;
}

// What lies behind the face is a blind in a window when wall is seen above most of it, when it
// hangs over a hole, or when wall frames it on three sides; otherwise it is the wall, and what
// stands before it was taken for the face.
bool Fixtures::is_in_a_recess(const PlaneGrids& grids, const PlaneGrid& grid,
                              float face_m) const noexcept {
  std::size_t hanging = 0;
  std::size_t framed = 0;
  for (const Place& at : layer_) {
    const Surroundings around = surroundings_of(grids, grid, face_m, at.column, at.row);
    hanging += around.above || around.hole ? 1U : 0U;
    framed += around.below && around.left && around.right ? 1U : 0U;
  }
  return 2 * hanging > layer_.size() || 2 * framed > layer_.size();
}

bool Fixtures::is_of_the_wall(const Model& model, const Plane& plane,
                              const PlaneGrid& grid) const noexcept {
  Place low = layer_.front();
  Place high = low;
  for (const Place& at : layer_) {
    low = {std::min(low.column, at.column), std::min(low.row, at.row)};
    high = {std::max(high.column, at.column), std::max(high.row, at.row)};
  }
  const float bottom = grid.centre(plane, low.column, low.row).z() - kCellM / 2;
  const float width = static_cast<float>(high.column - low.column + 1) * kCellM;
  const float height = static_cast<float>(high.row - low.row + 1) * kCellM;
  const float solid = static_cast<float>(layer_.size()) * kCellM * kCellM / (width * height);
  if (std::isinf(model.floor_z) || bottom > model.floor_z + kToFloorM) return false;
  const bool like_a_door = height >= kDoorHeightM && width >= kLeastDoorM && width <= kMostDoorM;
  return (like_a_door || height >= kRoomHighM) && solid >= kSolid;
}

}  // namespace convexcut::robust
