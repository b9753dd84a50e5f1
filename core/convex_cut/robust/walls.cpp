// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/walls.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "core/convex_cut/robust/furniture.hpp"
#include "core/convex_cut/robust/second_look.hpp"

namespace convexcut::robust {
namespace {

constexpr std::size_t kMostColumns = 1U << 14U;
constexpr std::size_t kMostSegments = 2'048;
constexpr std::int32_t kGap = 2;  // columns within a run that may be missing
constexpr float kToCeilingM = 0.35F;
constexpr float kWidestScreenM = 2.5F;
constexpr std::int32_t kLeastPassed = 3;  // rows, beside a screen
constexpr float kBelowCeilingM = 0.45F;
constexpr float kRough = 2.5F;           // spread², relative to the noise²
constexpr float kRoughWhereEven = 5.0F;  // a long wall with things on it
constexpr float kFewSteps = 0.2F;        // share of neighbouring cells
constexpr float kMostSteps = 0.25F;
constexpr float kUneven = 1.0F;  // spread², where there are more
constexpr float kStepM = 0.015F;
constexpr std::int32_t kLeastPoints = 8;  // of a cell, for its mean
constexpr std::int32_t kLeastPairs = 7;
constexpr std::int32_t kBeside = 2;
constexpr float kMarginM = 0.2F;  // to floor and ceiling
constexpr std::uint32_t kLeastCells = 4;
constexpr std::uint32_t kLargeCells = 40;       // of a wall, in all
constexpr std::int32_t kLeastAroundWindow = 4;  // cells of a column
constexpr std::int32_t kLeastSeen = 3;          // of a closed column among open ones
constexpr float kSeenOver = 0.15F;              // share of a run, for all of it that is no higher
constexpr float kSeenOverLow = 0.05F;           // the same of what ends below the lidar

// The share of neighbouring cells of columns [first, end) whose means differ: great where depths
// change from book to book, small on a wall with a picture on it. 0 where too few are known.
[[nodiscard]] float share_of_steps(const PlaneGrids& grids, const PlaneGrid& grid,
                                   std::int32_t first, std::int32_t end) noexcept {
  std::int32_t pairs = 0;
  std::int32_t steps = 0;
  const auto compare = [&](const Cell& cell, const Cell& next) {
    if (cell.points < kLeastPoints || next.points < kLeastPoints) return;
    ++pairs;
    steps += std::abs(cell.mean_m() - next.mean_m()) > kStepM ? 1 : 0;
  };
  for (std::int32_t c = first; c < end; ++c) {
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      const Cell& cell = grids.cell(grid, c, row);
      if (c + 1 < end) compare(cell, grids.cell(grid, c + 1, row));
      if (row + 1 < grid.rows) compare(cell, grids.cell(grid, c, row + 1));
    }
  }
  return pairs < kLeastPairs ? 0.0F : static_cast<float>(steps) / static_cast<float>(pairs);
}

// Of the points on a segment, about the plane.
[[nodiscard]] float spread2_of(const PlaneGrids& grids, const WallSegment& segment) noexcept {
  float squares_m2 = 0.0F;
  std::int32_t points = 0;
  grids.for_each_cell(segment, [&](const Cell& cell) {
    squares_m2 += cell.square_sum_m2;
    points += cell.points;
  });
  return squares_m2 / static_cast<float>(std::max(points, 1));
}

// Fronts of books, folds of curtains. Of narrow faces the shape is told elsewhere, and a wall up to
// the ceiling is rough by what hangs on it.
[[nodiscard]] bool is_rough(const Model& model, const WallSegment& s) noexcept {
  if (s.width_m() < kNarrowM || s.top_m > model.ceiling_z - kToCeilingM) return false;
  const float spread = model.planes[s.plane].spread2 / model.noise2;
  const float rough = s.steps > 0.0F && s.steps < kFewSteps ? kRoughWhereEven : kRough;
  return spread > rough || (spread > kUneven && s.steps > kMostSteps);
}

// Whether rays pass columns [first, end) in most of the segment's rows of which anything is known.
[[nodiscard]] bool is_passed(const Model& model, const PlaneGrids& grids, const WallSegment& s,
                             std::int32_t first, std::int32_t end) noexcept {
  const PlaneGrid& grid = grids.grid(s.plane);
  std::int32_t rows = 0;
  std::int32_t passed = 0;
  for (std::int32_t row = 0; row < grid.rows; ++row) {
    const float z = grid.centre(model.planes[s.plane], s.first, row).z();
    if (z < s.bottom_m || z > s.top_m) continue;
    bool row_passed = false;
    bool row_seen = false;
    for (std::int32_t c = first; c < end; ++c) {
      if (!grid.holds(c, row)) continue;
      const Cell& cell = grids.cell(grid, c, row);
      row_passed = row_passed || cell.passed >= kPassed;
      row_seen = row_seen || cell.seen > 0;
    }
    passed += row_passed ? 1 : 0;
    rows += row_passed || row_seen ? 1 : 0;
  }
  return passed >= kLeastPassed && 2 * passed > rows;
}

[[nodiscard]] std::int32_t count_seen(const PlaneGrids& grids, std::size_t plane,
                                      std::int32_t column) noexcept {
  const PlaneGrid& grid = grids.grid(plane);
  std::int32_t count = 0;
  for (std::int32_t row = 0; row < grid.rows; ++row) {
    count += grids.cell(grid, column, row).seen > 0 ? 1 : 0;
  }
  return count;
}

struct Columns {
  std::int32_t first = 0, end = 0;
};

// Without a chair's legs in the plane of a board.
[[nodiscard]] Columns without_legs(const PlaneGrids& grids, const WallSegment& s) noexcept {
  Columns columns{s.first, s.end};
  const auto is_leg = [&](std::int32_t c) { return count_seen(grids, s.plane, c) < kLeastSeen; };
  while (columns.first < columns.end && is_leg(columns.first)) ++columns.first;
  while (columns.first < columns.end && is_leg(columns.end - 1)) --columns.end;
  return columns;
}

// Beside which of its ends rays pass.
void mark_free_ends(const Model& model, const PlaneGrids& grids, WallSegment& s) noexcept {
  const auto [first, end] = without_legs(grids, s);
  s.free_begin = is_passed(model, grids, s, first - kBeside, first);
  s.free_end = is_passed(model, grids, s, end, end + kBeside);
}

// Whether rays pass on both sides of what ends below the ceiling: a board on wheels, a screen.
[[nodiscard]] bool stands_free(const Model& model, const PlaneGrids& grids,
                               const WallSegment& s) noexcept {
  if (!s.free_begin || !s.free_end) return false;
  if (s.top_m > model.ceiling_z - kBelowCeilingM || s.width_m() < kNarrowM) return false;
  const auto [first, end] = without_legs(grids, s);
  if (static_cast<float>(end - first) * kCellM > kWidestScreenM) return false;
  return std::none_of(model.segments.begin(), model.segments.end(), [&](const WallSegment& other) {
    return &other != &s && other.plane == s.plane && other.closed > s.closed;
  });
}

// What is passed above, but stands in the plane of a larger wall, is that wall beneath a window.
void accept_under_windows(Model& model) noexcept {
  for (WallSegment& s : model.segments) {
    if (s.accepted || s.width_m() < kNarrowM) continue;
    std::uint32_t closed = 0;
    for (const WallSegment& other : model.segments) {
      if (other.plane == s.plane && other.open < other.closed) closed += other.closed;
    }
    s.accepted = closed >= kLargeCells && closed > s.open + s.closed;
  }
}

// Of a run's columns: reached by a quarter of them. Ghosts and what hangs above reach higher in
// some.
[[nodiscard]] float top_of(std::span<float> tops_m) noexcept {
  if (tops_m.empty()) return -1e9F;
  const auto quarter = tops_m.begin() + static_cast<std::ptrdiff_t>(tops_m.size() / 4);
  std::nth_element(tops_m.begin(), quarter, tops_m.end(), std::greater<>());
  return *quarter;
}

}  // namespace

Walls::Walls() {
  columns_.reserve(kMostColumns);
  tops_m_.reserve(kMostColumns);
}

void Walls::find(Model& model, PlaneGrids& grids, const Sighting& sighting,
                 const RobustParameters& parameters) noexcept {
  lidar_z_ = sighting.lidar.z();
  model.segments.clear();
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    if (!model.planes[k].vertical || model.planes[k].edge_on) continue;
    take_columns(model, grids, k);
    split(model, grids, k, parameters.free_space);
  }
  accept_under_windows(model);
  if (parameters.furniture) {
    for (WallSegment& s : model.segments) {
      if (s.accepted) mark_free_ends(model, grids, s);
      s.accepted = s.accepted && !is_rough(model, s) && !stands_free(model, grids, s);
    }
    reject_furniture(model);
    take_second_look(model, grids, sighting);
  }
  for (const WallSegment& segment : model.segments) {
    if (!segment.accepted) continue;
    model.planes[segment.plane].accepted = true;
    grids.for_each_cell(segment, [](Cell& cell) {
      if (cell.seen > 0) cell.structure = true;
    });
  }
}

void Walls::take_columns(const Model& model, const PlaneGrids& grids, std::size_t plane) noexcept {
  const PlaneGrid& grid = grids.grid(plane);
  columns_.clear();
  for (std::int32_t c = 0; c < grid.columns; ++c) {
    Column column;
    std::int32_t through = 0;  // cells that are seen and passed: glass
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      const Cell& cell = grids.cell(grid, c, row);
      if (cell.seen > 0) {
        if (column.seen++ == 0) column.bottom = row;
        column.top = row;
        column.open_above = false;
      }
      if (cell.passed < kPassed) continue;
      const float z = grid.centre(model.planes[plane], c, row).z();
      if (z > model.floor_z + kMarginM && z < model.ceiling_z - kMarginM) {
        ++(cell.seen > 0 ? through : column.open);
        column.open_above = cell.seen == 0;
      }
    }
    column.is_gap =
        column.open >= kLeastPassed && column.seen < kLeastSeen && through == column.seen;
    // What ends within a cell does not let through what passes over it.
    const bool ends_within =
        through == 1 && column.open_above && grids.cell(grid, c, column.top).passed >= kPassed;
    const bool is_glass = through >= column.open && !ends_within;
    if (is_glass || goes_up_to_ceiling(model, grids, plane, c, column)) column.open = 0;
    columns_.push_back(column);
  }
}

// What reaches up to the ceiling and is passed below only: a beam, a lintel. Or is seen over all
// that is passed, and in a metre of its height: a wall with a window.
bool Walls::goes_up_to_ceiling(const Model& model, const PlaneGrids& grids, std::size_t plane,
                               std::int32_t c, const Column& column) noexcept {
  const PlaneGrid& grid = grids.grid(plane);
  if (column.seen == 0 || std::isinf(model.ceiling_z) ||
      grid.centre(model.planes[plane], c, column.top).z() < model.ceiling_z - kToCeilingM) {
    return false;
  }
  if (column.seen >= kLeastAroundWindow && !column.open_above) return true;
  for (std::int32_t row = column.bottom; row < grid.rows; ++row) {
    const bool is_above_ceiling =
        grid.centre(model.planes[plane], c, row).z() > model.ceiling_z - kMarginM;
    if (!is_above_ceiling && grids.cell(grid, c, row).passed >= kPassed) return false;
  }
  return true;
}

void Walls::split(Model& model, const PlaneGrids& grids, std::size_t plane,
                  bool free_space) noexcept {
  const auto count = static_cast<std::int32_t>(columns_.size());
  const auto seen = [this](std::int32_t c) { return columns_[static_cast<std::size_t>(c)].seen; };
  const auto is_gap = [this](std::int32_t c) {
    return columns_[static_cast<std::size_t>(c)].is_gap;
  };
  for (std::int32_t first = 0; first < count; ++first) {
    if (seen(first) == 0 || is_gap(first)) continue;
    std::int32_t last = first;
    for (std::int32_t c = first; c < count && c - last <= kGap; ++c) {
      if (is_gap(c)) break;
      if (seen(c) > 0) last = c;
    }
    if (free_space) {
      split_run(model, grids, plane, first, last + 1);
    } else {
      add_segment(model, grids, plane, first, last + 1, true);
    }
    first = last;
  }
}

// Where something behind is seen over a part of a run, what is no higher beside it ends there too,
// although nothing is seen over that. A wall's top is seldom below the lidar; a counter's is, and
// along its front few rays get over it.
void Walls::open_below_top(const Model& model, const PlaneGrids& grids, std::size_t plane,
                           std::int32_t first, std::int32_t end) noexcept {
  std::int32_t seen = 0;
  std::int32_t seen_over = 0;
  std::int32_t top = -1;
  for (std::int32_t c = first; c < end; ++c) {
    const Column& column = columns_[static_cast<std::size_t>(c)];
    seen += column.seen;
    if (column.seen == 0 || column.open == 0 || !column.open_above) continue;
    seen_over += column.seen;
    top = std::max(top, column.top);
  }
  if (seen_over == 0) return;
  const float top_z = grids.grid(plane).centre(model.planes[plane], first, top).z() + kCellM / 2;
  const float share = top_z < lidar_z_ ? kSeenOverLow : kSeenOver;
  if (static_cast<float>(seen_over) < share * static_cast<float>(seen)) return;
  for (std::int32_t c = first; c < end; ++c) {
    Column& column = columns_[static_cast<std::size_t>(c)];
    if (column.top <= top + 1) column.open = std::max(column.open, 1);
  }
}

// Accepts a run as a whole when most of it is closed; of the others, the closed parts that reach
// higher than all of the open ones (a pillar between bookcases).
void Walls::split_run(Model& model, const PlaneGrids& grids, std::size_t plane, std::int32_t first,
                      std::int32_t end) noexcept {
  open_below_top(model, grids, plane, first, end);
  std::int32_t closed = 0;
  std::int32_t open = 0;
  std::int32_t open_top = -1;
  for (std::int32_t c = first; c < end; ++c) {
    const Column& column = columns_[static_cast<std::size_t>(c)];
    (column.open > 0 ? open : closed) += column.seen;
    if (column.seen > 0 && column.open > 0) open_top = std::max(open_top, column.top);
  }
  if (closed >= open) {
    add_segment(model, grids, plane, first, end, closed + open >= static_cast<int>(kLeastCells));
    return;
  }
  const auto stands_out = [&](std::int32_t c) {
    const Column& column = columns_[static_cast<std::size_t>(c)];
    return column.open == 0 && column.seen >= kLeastSeen && column.top > open_top + 1;
  };
  bool any = false;
  for (std::int32_t c = first; c < end; ++c) {
    if (!stands_out(c)) continue;
    std::int32_t stop = c;
    while (stop < end && stands_out(stop)) ++stop;
    add_segment(model, grids, plane, c, stop, true);
    any = true;
    c = stop;
  }
  if (!any) add_segment(model, grids, plane, first, end, false);
}

void Walls::add_segment(Model& model, const PlaneGrids& grids, std::size_t plane,
                        std::int32_t first, std::int32_t end, bool accepted) noexcept {
  if (model.segments.size() == model.segments.capacity() ||
      model.segments.size() >= kMostSegments) {
    return;
  }
  const PlaneGrid& grid = grids.grid(plane);
  WallSegment segment;
  segment.plane = plane;
  segment.first = first;
  segment.end = end;
  segment.accepted = accepted;
  segment.begin_m = segment.bottom_m = 1e9F;
  segment.end_m = -1e9F;
  tops_m_.clear();
  for (std::int32_t c = first; c < end; ++c) {
    const Column& column = columns_[static_cast<std::size_t>(c)];
    if (column.seen == 0) continue;
    (column.open > 0 ? segment.open : segment.closed) += static_cast<std::uint32_t>(column.seen);
    const Extent& extent = grids.extent(grid, c);
    segment.begin_m = std::min(segment.begin_m, extent.low_m);
    segment.end_m = std::max(segment.end_m, extent.high_m);
    const Plane& p = model.planes[plane];
    segment.bottom_m =
        std::min(segment.bottom_m, grid.centre(p, c, column.bottom).z() - kCellM / 2);
    tops_m_.push_back(grid.centre(p, c, column.top).z() + kCellM / 2);
  }
  segment.top_m = top_of(tops_m_);
  segment.steps = share_of_steps(grids, grid, first, end);
  segment.spread2 = spread2_of(grids, segment);
  model.segments.push_back(segment);
}

}  // namespace convexcut::robust
