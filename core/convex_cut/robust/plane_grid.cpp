// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/plane_grid.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "core/convex_cut/robust/cell_set.hpp"
#include "core/convex_cut/robust/plane_search.hpp"
#include "core/convex_cut/robust/ray_kernels.hpp"

namespace convexcut::robust {
namespace {

constexpr std::int32_t kUnknownCells = 16;  // 4 m: more than a step of a lidar that turns adds

constexpr std::size_t kMostCells = 1U << 18U;
constexpr std::size_t kMostExtents = 1U << 14U;
constexpr std::int32_t kMargin = 2;  // cells around what was seen
static_assert(kMargin >= CellSet::kReach, "so that a neighbourhood of what was seen is within");
// Flat planes reach as far beyond their rectangle, which has at least five rows, on both sides.
constexpr std::size_t kBeyond = std::size_t{2} * (kFlatReach - kMargin);
constexpr std::size_t kMostReach = kMostCells + kBeyond * (kMostExtents + kMostCells / 5) +
                                   kBeyond * kBeyond * PlaneSearch::kMostPlanes;
constexpr std::int32_t kMarginUp = 12;  // of vertical planes: from floor to ceiling
constexpr float kBehindM = 0.15F;       // a ray that ends so far behind a plane passed it
constexpr float kEdgeM = 0.02F;
constexpr float kAnywhereM = 1e9F;

struct Bounds {
  std::int32_t low_along = std::numeric_limits<std::int32_t>::max();
  std::int32_t high_along = std::numeric_limits<std::int32_t>::min();
  std::int32_t low_up = std::numeric_limits<std::int32_t>::max();
  std::int32_t high_up = std::numeric_limits<std::int32_t>::min();
};

[[nodiscard]] PlaneGrid axes_of(const Plane& plane) noexcept {
  PlaneGrid grid;
  const Vec3f across = plane.vertical ? Vec3f::UnitZ() : Vec3f::UnitY();
  grid.along = across.cross(plane.normal).normalized();
  grid.up = plane.normal.cross(grid.along);
  return grid;
}

[[nodiscard]] bool fits(const PlaneGrid& grid, std::size_t cells, std::size_t extents) noexcept {
  return grid.columns > 0 && static_cast<std::size_t>(grid.columns) + extents <= kMostExtents &&
         grid.cell_count() + cells <= kMostCells;
}

}  // namespace

PlaneGrids::PlaneGrids(std::size_t max_surfels) : rays_(max_surfels) {
  grids_.reserve(PlaneSearch::kMostPlanes);
  sites_.reserve(max_surfels);
  cell_of_surfel_.resize(max_surfels);
  cells_.reserve(kMostCells);
  extents_.reserve(kMostExtents);
  passable_.reserve(kMostExtents);
  reach_.reserve(kMostReach);
  structure_.reserve(kMostReach);
  widened_.reserve(kMostReach);
}

void PlaneGrids::build(Model& model) noexcept {
  grids_.clear();
  cells_.clear();
  extents_.clear();
  lay_out(model);
  mark_seen(model);
  widen_extents();
  mark_passed(model);
}

void PlaneGrids::turn(Plane& plane, const PlaneGrid& grid, const Vec3f& about, float along,
                      float up) noexcept {
  const Plane before = plane;
  plane.normal = (plane.normal - grid.along * along - grid.up * up).normalized();
  plane.offset = -plane.normal.dot(about);
  for (std::int32_t row = 0; row < grid.rows; ++row) {
    for (std::int32_t column = 0; column < grid.columns; ++column) {
      Cell& of_grid = cell(grid, column, row);
      of_grid.height_sum_m +=
          static_cast<float>(of_grid.points) * plane.height_of(grid.centre(before, column, row));
    }
  }
}

void PlaneGrids::lay_out(Model& model) noexcept {
  std::array<Bounds, PlaneSearch::kMostPlanes> bounds;
  for (const Plane& plane : model.planes) grids_.push_back(axes_of(plane));
  sites_.clear();
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    const Surfel& surfel = model.surfels[i];
    if (surfel.plane == kNoPlane) continue;
    const auto k = static_cast<std::size_t>(surfel.plane);
    Bounds& b = bounds[k];
    const std::int32_t along = grids_[k].column_of(surfel.mean);
    const std::int32_t up = grids_[k].row_of(surfel.mean);
    sites_.push_back({static_cast<std::uint32_t>(i), along, up});
    b.low_along = std::min(b.low_along, along);
    b.high_along = std::max(b.high_along, along);
    b.low_up = std::min(b.low_up, up);
    b.high_up = std::max(b.high_up, up);
  }
  for (std::size_t k = 0; k < grids_.size(); ++k) {
    PlaneGrid& grid = grids_[k];
    const Bounds& b = bounds[k];
    if (b.low_along > b.high_along) continue;
    const std::int32_t margin_up = model.planes[k].vertical ? kMarginUp : kMargin;
    grid.first_along = b.low_along - kMargin;
    grid.first_up = b.low_up - margin_up;
    grid.columns = b.high_along - b.low_along + 1 + 2 * kMargin;
    grid.rows = b.high_up - b.low_up + 1 + 2 * margin_up;
    if (!fits(grid, cells_.size(), extents_.size())) {
      grid.columns = grid.rows = 0;
      continue;
    }
    grid.first_cell = cells_.size();
    grid.first_extent = extents_.size();
    cells_.resize(cells_.size() + grid.cell_count());
    extents_.resize(extents_.size() + static_cast<std::size_t>(grid.columns));
  }
}

void PlaneGrids::mark_seen(const Model& model) noexcept {
  for (const Site& site : sites_) {
    const Surfel& surfel = model.surfels[site.surfel];
    const PlaneGrid& g = grids_[static_cast<std::size_t>(surfel.plane)];
    const std::int32_t column = site.along - g.first_along;
    const std::int32_t row = site.up - g.first_up;
    cell_of_surfel_[site.surfel] = kNoCell;
    if (!g.holds(column, row)) continue;
    cell_of_surfel_[site.surfel] = static_cast<std::uint32_t>(index(g, column, row));
    Cell& seen = cell(g, column, row);
    ++seen.seen;
    seen.points += surfel.points;
    seen.height_sum_m +=
        static_cast<float>(surfel.points) *
        model.planes[static_cast<std::size_t>(surfel.plane)].height_of(surfel.mean);
    seen.square_sum_m2 += static_cast<float>(surfel.points) * surfel.spread2;
    Extent& extent = extents_[g.first_extent + static_cast<std::size_t>(column)];
    const float along = g.along.dot(surfel.mean);
    extent.low_m = std::min(extent.low_m, along);
    extent.high_m = std::max(extent.high_m, along);
  }
}

// Where the neighbouring column was seen as well, the surface reaches the border between them.
void PlaneGrids::widen_extents() noexcept {
  for (const PlaneGrid& g : grids_) {
    for (std::int32_t column = 0; column < g.columns; ++column) {
      Extent& here = extents_[g.first_extent + static_cast<std::size_t>(column)];
      if (here.empty()) continue;
      const float border = static_cast<float>(g.first_along + column) * kCellM;
      if (column > 0 && !extent(g, column - 1).empty()) here.low_m = border;
      if (column + 1 < g.columns && !extent(g, column + 1).empty()) here.high_m = border + kCellM;
    }
  }
}

// Beside what was seen in the column is not above it. Neighbours that touch leave no gap.
void PlaneGrids::take_passable(const PlaneGrid& g) noexcept {
  for (std::int32_t column = 0; column < g.columns; ++column) {
    const Extent& e = extent(g, column);
    const float border = static_cast<float>(g.first_along + column) * kCellM;
    Extent& passable = passable_[g.first_extent + static_cast<std::size_t>(column)];
    passable.low_m = e.low_m > border ? e.low_m + kEdgeM : border;
    passable.high_m = e.high_m < border + kCellM ? e.high_m - kEdgeM : border + kCellM;
    if (e.empty()) passable = {-kAnywhereM, kAnywhereM};
  }
}

void PlaneGrids::mark_passed(const Model& model) noexcept {
  rays_.clear();
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    const Surfel& surfel = model.surfels[i];
    if (surfel.is_evidence()) rays_.add(i, surfel.origin, surfel.mean);
  }
  passable_.resize(extents_.size());
  for (std::size_t k = 0; k < grids_.size(); ++k) {
    if (model.planes[k].vertical) take_passable(grids_[k]);
  }
  Passages passages;
  for (std::size_t begin = 0; begin < rays_.size(); begin += kRaysAtOnce) {
    for (std::size_t k = 0; k < grids_.size(); ++k) {
      find_passages(rays_, begin, model.planes[k], grids_[k], kBehindM, kInFrontM, passages);
      count_passages(model, k, passages);
    }
  }
}

void PlaneGrids::count_passages(const Model& model, std::size_t plane,
                                const Passages& passages) noexcept {
  const PlaneGrid& g = grids_[plane];
  for (std::size_t i = 0; i < passages.count; ++i) {
    if (model.planes[plane].vertical) {
      const Extent& e = passable_[g.first_extent + static_cast<std::size_t>(passages.column[i])];
      if (passages.along_m[i] < e.low_m || passages.along_m[i] > e.high_m) continue;
    }
    std::uint16_t& passed =
        cells_[g.first_cell + static_cast<std::size_t>(passages.cell[i])].passed;
    if (passed < std::numeric_limits<std::uint16_t>::max()) ++passed;
  }
}

float PlaneGrids::layer_near(std::size_t plane, const Vec3f& p) const noexcept {
  const PlaneGrid& g = grids_[plane];
  if (!g.has_layers) return 0.0F;
  const std::int32_t column = g.column_of(p);
  const std::int32_t row = g.row_of(p);
  if (g.holds(column, row) && cell(g, column, row).layer_m != 0.0F) {
    return cell(g, column, row).layer_m;
  }
  float layer = 0.0F;
  for (std::int32_t r = std::max(row - 1, 0); r <= std::min(row + 1, g.rows - 1); ++r) {
    for (std::int32_t c = std::max(column - 1, 0); c <= std::min(column + 1, g.columns - 1); ++c) {
      const float here = cell(g, c, r).layer_m;
      if (std::abs(here) > std::abs(layer)) layer = here;
    }
  }
  return layer;
}

bool PlaneGrids::is_structure(std::size_t plane, const Vec3f& p,
                              std::int32_t around) const noexcept {
  const PlaneGrid& g = grids_[plane];
  const std::int32_t column = g.column_of(p);
  const std::int32_t row = g.row_of(p);
  if (g.holds(column, row)) {
    const Cell& at = cell(g, column, row);
    if (at.enclosed || at.structure) return !at.enclosed;
  }
  for (std::int32_t r = std::max(row - around, 0); r <= std::min(row + around, g.rows - 1); ++r) {
    for (std::int32_t c = std::max(column - around, 0);
         c <= std::min(column + around, g.columns - 1); ++c) {
      if (cell(g, c, r).structure) return true;
    }
  }
  return false;
}

bool PlaneGrids::goes_on_to(std::size_t plane, const Vec3f& p) const noexcept {
  const PlaneGrid& g = grids_[plane];
  const std::int32_t column = g.column_of(p);
  const std::int32_t row = g.row_of(p);
  if (g.holds(column, row)) {
    const Cell& at = cell(g, column, row);
    if (at.enclosed || at.passed > 0) return false;
  }
  const auto meets_structure = [&](std::int32_t columns, std::int32_t rows) {
    for (std::int32_t i = 1; i <= kUnknownCells; ++i) {
      if (!g.holds(column + i * columns, row + i * rows)) continue;
      const Cell& at = cell(g, column + i * columns, row + i * rows);
      if (at.structure) return true;
      if (at.seen > 0 || at.passed > 0) return false;
    }
    return false;
  };
  return meets_structure(1, 0) || meets_structure(-1, 0) || meets_structure(0, 1) ||
         meets_structure(0, -1);
}

void PlaneGrids::mark_reach(const Model& model) noexcept {
  reach_.clear();
  for (std::size_t k = 0; k < grids_.size(); ++k) {
    grids_[k].has_reach = model.planes[k].accepted && grids_[k].columns > 0;
    if (grids_[k].has_reach) mark_reach(model.planes[k], grids_[k]);
  }
}

void PlaneGrids::mark_reach(const Plane& plane, PlaneGrid& g) noexcept {
  g.around = plane.vertical ? 0 : kFlatReach - kMargin;
  g.first_reach = reach_.size();
  const auto around = static_cast<std::size_t>(g.around);
  const auto columns = static_cast<std::size_t>(g.columns);
  const std::size_t width = columns + 2 * around;
  const std::size_t size = width * (static_cast<std::size_t>(g.rows) + 2 * around);
  structure_.assign(size, 0);
  for (std::int32_t row = 0; row < g.rows; ++row) {
    std::uint8_t* to = &structure_[(static_cast<std::size_t>(row) + around) * width + around];
    const Cell* from = &cell(g, 0, row);
    for (std::size_t c = 0; c < columns; ++c) {
      to[c] = from[c].structure ? 1 : 0;
      g.has_layers = g.has_layers || from[c].layer_m != 0.0F;
    }
  }
  widen(width, 1);
  reach_.resize(g.first_reach + size);
  std::uint8_t* reach = &reach_[g.first_reach];
  for (std::size_t i = 0; i < size; ++i) reach[i] = structure_[i] != 0 ? kBeside : 0;
  if (!plane.vertical) {
    widen(width, 2);
    widen(width, 3);
  }
  for (std::size_t i = 0; i < size; ++i) {
    reach[i] = static_cast<std::uint8_t>(reach[i] | (structure_[i] != 0 ? kWithinReach : 0));
  }
  for (std::int32_t row = 0; row < g.rows; ++row) {
    std::uint8_t* to = &reach[(static_cast<std::size_t>(row) + around) * width + around];
    const Cell* from = &cell(g, 0, row);
    for (std::size_t c = 0; c < columns; ++c) to[c] = from[c].enclosed ? 0 : to[c];
  }
}

// Structure that was widened by 1 is by 3 when it is widened by 2 more steps at once, and so on. It
// is kMargin + around cells away from all borders: rows do not run into each other.
void PlaneGrids::widen(std::size_t width, std::size_t by) noexcept {
  const std::size_t size = structure_.size();
  widened_.resize(size);
  for (const std::size_t step : {by, by * width}) {
    std::copy(structure_.begin(), structure_.end(), widened_.begin());
    for (std::size_t i = step; i < size; ++i) {
      widened_[i] = static_cast<std::uint8_t>(widened_[i] | structure_[i - step]);
    }
    for (std::size_t i = step; i < size; ++i) {
      widened_[i - step] = static_cast<std::uint8_t>(widened_[i - step] | structure_[i]);
    }
    std::swap(structure_, widened_);
  }
}

}  // namespace convexcut::robust
