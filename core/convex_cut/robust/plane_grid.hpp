// SPDX-License-Identifier: Apache-2.0
//
// Each plane as a grid of cells: where it was seen, and where something farther away was seen
// through it. A surface that bounds the free space is not passed by any ray, nor do rays pass
// beside it where structure would go on: above a wall's part, around a floor's.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/rays.hpp"
#include "core/workspace.hpp"

namespace convexcut::robust {

inline constexpr float kCellM = 0.25F;
inline constexpr float kFloorReachM = 0.35F;  // over the floor: cells below have points of it
inline constexpr float kInFrontM = 0.05F;  // a ray that starts nearer to a plane says nothing of it

// Cells around structure that belong to it: of flat surfaces, between two rings on a far floor; of
// walls, the next.
inline constexpr std::int32_t kFlatReach = 6;
inline constexpr std::int32_t kWallReach = 1;

inline constexpr std::uint16_t kPassed = 2;            // rays; one alone may be a ghost's
inline constexpr std::int32_t kLeastDepthPoints = 20;  // of a cell: a mean to half a centimetre

struct Cell {
  std::uint16_t seen = 0;      // surfels of the plane
  std::uint16_t passed = 0;    // rays that end well behind the plane
  std::int16_t part = -1;      // of a flat plane: connected cells
  std::int32_t points = 0;     // of these surfels
  float height_sum_m = 0.0F;   // of the points, over the plane
  float square_sum_m2 = 0.0F;  // of these heights
  float layer_m = 0.0F;        // how far the fixture that covers the cell is off the wall; 0: none
  float inset_m = 0.0F;        // the same of a part of the wall: a door, a pane; 0: none
  bool structure = false;
  bool before = false;    // something is seen close before it
  bool hidden = false;    // the same, on the way of the lidar's rays to it
  bool between = false;   // that above and below
  bool enclosed = false;  // the back of a shelf
  bool visited = false;

  // Whether rays go through the plane here.
  [[nodiscard]] bool is_hole() const noexcept { return seen == 0 && passed >= kPassed; }
  [[nodiscard]] bool tells_depth() const noexcept { return points >= kLeastDepthPoints; }
  [[nodiscard]] float mean_m() const noexcept { return height_sum_m / static_cast<float>(points); }
};

// A plane's axes and its rectangle of cells. Vertical planes: `along` is horizontal, `up` is
// upwards; a column is what stands above one step along.
struct PlaneGrid {
  Vec3f along = Vec3f::UnitX();
  Vec3f up = Vec3f::UnitY();
  std::int32_t first_along = 0, first_up = 0;  // in cells from the frame's origin
  std::int32_t columns = 0, rows = 0;
  std::size_t first_cell = 0;
  std::size_t first_extent = 0;
  std::int32_t around = 0;      // cells on each side that structure reaches beyond the rectangle
  std::size_t first_reach = 0;  // of the rectangle with those
  bool has_reach = false;       // of an accepted plane
  bool has_layers = false;      // of such a one: fixtures on it

  [[nodiscard]] std::int32_t column_of(const Vec3f& p) const noexcept {
    return static_cast<std::int32_t>(std::floor(along.dot(p) / kCellM)) - first_along;
  }
  [[nodiscard]] std::int32_t row_of(const Vec3f& p) const noexcept {
    return static_cast<std::int32_t>(std::floor(up.dot(p) / kCellM)) - first_up;
  }
  [[nodiscard]] bool holds(std::int32_t column, std::int32_t row) const noexcept {
    return column >= 0 && row >= 0 && column < columns && row < rows;
  }
  [[nodiscard]] std::size_t cell_count() const noexcept {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  // Of the cell, on the plane.
  [[nodiscard]] Vec3f centre(const Plane& plane, std::int32_t column,
                             std::int32_t row) const noexcept {
    const auto at = [](std::int32_t i) { return (static_cast<float>(i) + 0.5F) * kCellM; };
    return along * at(first_along + column) + up * at(first_up + row) - plane.normal * plane.offset;
  }
};

// What was seen in a column of a vertical plane, along it. Empty: low > high.
struct Extent {
  float low_m = 1e9F;
  float high_m = -1e9F;
  [[nodiscard]] bool empty() const noexcept { return low_m > high_m; }
};

struct Passages;

class PlaneGrids {
 public:
  explicit PlaneGrids(std::size_t max_surfels);

  // For the model's planes; a plane that no room is left for loses its surfels.
  void build(Model& model) noexcept;
  // Turns a vertical plane about a point on it, by small slopes over itself along its axes. Its
  // cells keep their points: what the plane recedes there is added to their heights.
  void turn(Plane& plane, const PlaneGrid& grid, const Vec3f& about, float along,
            float up) noexcept;

  [[nodiscard]] const PlaneGrid& grid(std::size_t plane) const noexcept { return grids_[plane]; }
  [[nodiscard]] Cell& cell(const PlaneGrid& grid, std::int32_t column, std::int32_t row) noexcept {
    return cells_[index(grid, column, row)];
  }
  [[nodiscard]] const Cell& cell(const PlaneGrid& grid, std::int32_t column,
                                 std::int32_t row) const noexcept {
    return cells_[index(grid, column, row)];
  }
  [[nodiscard]] const Extent& extent(const PlaneGrid& grid, std::int32_t column) const noexcept {
    return extents_[grid.first_extent + static_cast<std::size_t>(column)];
  }
  // Calls visit(cell) for all of a plane's, row by row.
  template <class Visit>
  void for_each_cell(const PlaneGrid& grid, Visit&& visit) noexcept {
    for (Cell& cell : std::span(cells_).subspan(grid.first_cell, grid.cell_count())) visit(cell);
  }
  template <class Visit>
  void for_each_cell(const PlaneGrid& grid, Visit&& visit) const noexcept {
    for (const Cell& cell : std::span(cells_).subspan(grid.first_cell, grid.cell_count())) {
      visit(cell);
    }
  }
  // Calls visit(cell) for those of a segment's columns, from the bottom up, column by column.
  template <class Visit>
  void for_each_cell(const WallSegment& segment, Visit&& visit) noexcept {
    visit_cells(*this, segment, visit);
  }
  template <class Visit>
  void for_each_cell(const WallSegment& segment, Visit&& visit) const noexcept {
    visit_cells(*this, segment, visit);
  }
  // Of the surfels that are evidence when the grids are built, in their order.
  [[nodiscard]] const Rays& rays() const noexcept { return rays_; }
  // Whether the cell at p, or one within `around` of it, is structure; not where it is enclosed.
  [[nodiscard]] bool is_structure(std::size_t plane, const Vec3f& p,
                                  std::int32_t around) const noexcept;
  // Whether the cell of the plane that the surfel lies on is; only of those that lie on one.
  [[nodiscard]] bool is_on_structure(std::size_t surfel) const noexcept {
    const std::uint32_t at = cell_of_surfel_[surfel];
    return at != kNoCell && cells_[at].structure && !cells_[at].enclosed;
  }

  // The same at once, when all is decided: for the two below.
  void mark_reach(const Model& model) noexcept;
  // is_structure() within 1, of the cell there.
  [[nodiscard]] bool is_beside_structure(std::size_t plane, std::int32_t column,
                                         std::int32_t row) const noexcept {
    return (reach_at(plane, column, row) & kBeside) != 0;
  }
  // is_structure() within kWallReach or kFlatReach.
  [[nodiscard]] bool is_within_reach(std::size_t plane, const Vec3f& p) const noexcept {
    return (reach_at(plane, p) & kWithinReach) != 0;
  }
  // Whether the plane's structure goes on to p, in its row or its column, over some cells of which
  // nothing is known yet.
  [[nodiscard]] bool goes_on_to(std::size_t plane, const Vec3f& p) const noexcept;
  // See Cell::inset_m.
  [[nodiscard]] float inset_at(std::size_t plane, const Vec3f& p) const noexcept {
    const PlaneGrid& g = grids_[plane];
    const std::int32_t column = g.column_of(p);
    const std::int32_t row = g.row_of(p);
    return g.holds(column, row) ? cell(g, column, row).inset_m : 0.0F;
  }
  // Once mark_reach() was called: the layer of the cell at p, or the greatest of those beside it;
  // 0: none.
  [[nodiscard]] float layer_near(std::size_t plane, const Vec3f& p) const noexcept;

 private:
  template <class Grids, class Visit>
  static void visit_cells(Grids& grids, const WallSegment& segment, Visit& visit) noexcept {
    const PlaneGrid& grid = grids.grid(segment.plane);
    for (std::int32_t column = segment.first; column < segment.end; ++column) {
      for (std::int32_t row = 0; row < grid.rows; ++row) visit(grids.cell(grid, column, row));
    }
  }
  [[nodiscard]] static std::size_t index(const PlaneGrid& grid, std::int32_t column,
                                         std::int32_t row) noexcept {
    return grid.first_cell +
           static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
           static_cast<std::size_t>(column);
  }
  // Of a surfel on its plane, in cells from the frame's origin.
  struct Site {
    std::uint32_t surfel;
    std::int32_t along, up;
  };
  static constexpr std::uint32_t kNoCell = 0xFFFF'FFFF;

  void lay_out(Model& model) noexcept;
  void mark_seen(const Model& model) noexcept;
  void widen_extents() noexcept;
  void take_passable(const PlaneGrid& grid) noexcept;
  void mark_passed(const Model& model) noexcept;
  void count_passages(const Model& model, std::size_t plane, const Passages& passages) noexcept;

  static constexpr std::uint8_t kBeside = 1;
  static constexpr std::uint8_t kWithinReach = 2;
  [[nodiscard]] std::uint8_t reach_at(std::size_t plane, const Vec3f& p) const noexcept {
    const PlaneGrid& g = grids_[plane];
    return reach_at(plane, g.column_of(p), g.row_of(p));
  }
  [[nodiscard]] std::uint8_t reach_at(std::size_t plane, std::int32_t of_column,
                                      std::int32_t of_row) const noexcept {
    const PlaneGrid& g = grids_[plane];
    const std::int32_t column = of_column + g.around;
    const std::int32_t row = of_row + g.around;
    const std::int32_t columns = g.columns + 2 * g.around;
    if (!g.has_reach || column < 0 || row < 0 || column >= columns ||
        row >= g.rows + 2 * g.around) {
      return 0;
    }
    return reach_[g.first_reach +
                  static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
  void mark_reach(const Plane& plane, PlaneGrid& grid) noexcept;
  void widen(std::size_t width, std::size_t by) noexcept;

  std::vector<PlaneGrid> grids_;
  std::vector<Site> sites_;  // of the surfels on planes
  Workspace<std::uint32_t> cell_of_surfel_;
  std::vector<std::uint8_t> reach_;                // kBeside, kWithinReach
  std::vector<std::uint8_t> structure_, widened_;  // of a plane with reach
  std::vector<Cell> cells_;
  std::vector<Extent> extents_;
  std::vector<Extent> passable_;  // by column of a vertical plane: where a ray is above or below it
  Rays rays_;
};

}  // namespace convexcut::robust
