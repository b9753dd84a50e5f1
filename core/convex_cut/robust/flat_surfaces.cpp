// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/flat_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/convex_cut/robust/plane_search.hpp"

namespace convexcut::robust {
namespace {

constexpr std::size_t kMostCellsOfAPart = 1U << 18U;
constexpr std::size_t kLeastCells = 6;
constexpr std::size_t kLeastCeilingCells = 20;  // less is the underside of a shelf
constexpr std::size_t kMostParts = 4'096;
constexpr float kLeastBeamM = 1.8F;
constexpr float kMostBeamM = 0.8F;
constexpr float kBeamHeightM = 0.7F;
constexpr float kTableM = 0.2F;           // above the floor
constexpr float kMostlyOver = 0.7F;       // of its extent
constexpr float kMostOpenRing = 0.25F;    // share of the ring that may be passed
constexpr float kMostOpenInside = 0.40F;  // and of the part itself
constexpr float kLevel = 0.97F;           // |z| of a normal
constexpr std::uint32_t kLargeSurfels = 30;
constexpr float kAboveM = 0.15F;
constexpr std::ptrdiff_t kMostAbove = 2;

[[nodiscard]] Eigen::Array2f level_size_m(const Vec3f& low, const Vec3f& high) noexcept {
  return (high - low).head<2>().array() + kCellM;
}

// Whether nothing is seen above a level plane, but for a few ghosts.
[[nodiscard]] bool is_topmost(const Model& model, std::size_t plane) noexcept {
  if (model.planes[plane].normal.z() > -kLevel) return false;
  return std::count_if(model.surfels.begin(), model.surfels.end(), [&](const Surfel& surfel) {
           return surfel.is_evidence() && model.planes[plane].height_of(surfel.mean) < -kAboveM;
         }) <= kMostAbove;
}

}  // namespace

void FlatSurfaces::Part::take_in(const Part& other) noexcept {
  cells += other.cells;
  low = low.cwiseMin(other.low);
  high = high.cwiseMax(other.high);
}

// Together no wider than a beam.
bool FlatSurfaces::is_in_line(const Part& a, const Part& b) noexcept {
  return a.plane == b.plane &&
         level_size_m(a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)).minCoeff() <= kMostBeamM;
}

bool FlatSurfaces::is_beam(const Part& part) noexcept {
  const Eigen::Array2f size_m = level_size_m(part.low, part.high);
  return size_m.maxCoeff() > kLeastBeamM && size_m.minCoeff() < kMostBeamM;
}

// Gaps within a part, and the ring around it, are as wide as CellSet reaches.
FlatSurfaces::FlatSurfaces() : unclaimed_(kMostCellsOfAPart), outside_(kMostCellsOfAPart) {
  part_.reserve(kMostCellsOfAPart);
  ring_.reserve(kMostCellsOfAPart);
  parts_.reserve(2 * kMostParts);
  open_parts_.reserve(kMostParts);
  undersides_.reserve(kMostParts);
}

void FlatSurfaces::find(Model& model, PlaneGrids& grids, const Vec3f& origin,
                        bool free_space) noexcept {
  parts_.clear();
  open_parts_.clear();
  undersides_.clear();
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    if (model.planes[k].vertical || model.planes[k].edge_on) continue;
    const PlaneGrid& grid = grids.grid(k);
    take_unclaimed(grids, grid);
    outside_.assign(grid.columns, grid.rows, true);
    std::int16_t id = 0;
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      for (std::int32_t column = 0; column < grid.columns; ++column) {
        if (!unclaimed_.contains(column, row)) continue;
        collect_part(grids, grid, {column, row}, id);
        if (part_.size() >= kLeastCells) {
          const bool bounds = !free_space || bounds_free_space(grids, grid);
          add_part(model.planes[k], k, grid, id, bounds ? parts_ : open_parts_);
        }
        ++id;
      }
    }
  }
  if (free_space) {
    reject_table_tops(model, origin);
    reject_undersides(model);
  }
  for (const Part& part : parts_) accept(model, grids, part);
  find_levels(model, origin);
  const std::size_t before = parts_.size();
  add_beams(model);
  for (std::size_t i = before; i < parts_.size(); ++i) accept(model, grids, parts_[i]);
}

void FlatSurfaces::take_unclaimed(const PlaneGrids& grids, const PlaneGrid& grid) noexcept {
  unclaimed_.assign(grid.columns, grid.rows, false);
  for (std::int32_t row = 0; row < grid.rows; ++row) {
    for (std::int32_t column = 0; column < grid.columns; ++column) {
      if (grids.cell(grid, column, row).seen > 0) unclaimed_.insert(column, row);
    }
  }
}

void FlatSurfaces::add_part(const Plane& plane, std::size_t k, const PlaneGrid& grid,
                            std::int16_t id, std::vector<Part>& parts) noexcept {
  if (parts.size() == kMostParts) return;
  Part part{k, id, part_.size(), Vec3f::Constant(1e9F), Vec3f::Constant(-1e9F)};
  for (const Place& at : part_) {
    const Vec3f centre = grid.centre(plane, at.column, at.row);
    part.low = part.low.cwiseMin(centre);
    part.high = part.high.cwiseMax(centre);
  }
  parts.push_back(part);
}

// Over the floor, and mostly within what was seen of it.
bool FlatSurfaces::is_above_floor(const Model& model, const Part& part,
                                  const Part& floor) noexcept {
  const Vec3f middle = (part.low + part.high) / 2;
  const Vec3f lowest(middle.x(), middle.y(), part.low.z());
  if (part.plane == floor.plane || part.cells > floor.cells ||
      model.planes[floor.plane].height_of(lowest) < kTableM) {
    return false;
  }
  const Eigen::Array2f size = level_size_m(part.low, part.high);
  const Eigen::Array2f shared =
      (part.high.cwiseMin(floor.high) - part.low.cwiseMax(floor.low)).head<2>().array() +
      3 * kCellM;
  return (shared > 0.0F).all() && shared.prod() > kMostlyOver * size.prod();
}

// All parts of the largest floor as one: furniture divides what is seen of it.
std::optional<FlatSurfaces::Part> FlatSurfaces::whole_floor(const Model& model,
                                                            const Vec3f& origin) const noexcept {
  std::optional<Part> largest;
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    if (model.planes[k].normal.z() < kLevel) continue;
    std::optional<Part> whole;
    for (const Part& part : parts_) {
      if (part.plane != k || part.high.z() > origin.z()) continue;
      if (!whole) {
        whole = part;
        continue;
      }
      whole->take_in(part);
    }
    if (whole && (!largest || whole->cells > largest->cells)) largest = whole;
  }
  return largest;
}

void FlatSurfaces::reject_table_tops(const Model& model, const Vec3f& origin) noexcept {
  const std::optional<Part> floor = whole_floor(model, origin);
  if (!floor) return;
  for (Part& part : parts_) {
    part.of_a_table =
        model.planes[part.plane].normal.z() > 0.0F && part.high.z() < origin.z() &&
        (is_above_floor(model, part, *floor) || is_of_table_tops(model, part, *floor));
  }
  std::erase_if(parts_, [](const Part& part) { return part.of_a_table; });
}

// At a height where rays pass around most of what is seen: tables are of one height, and what
// stands beside what was seen of the floor, or before a cupboard, is not passed itself.
bool FlatSurfaces::is_of_table_tops(const Model& model, const Part& part,
                                    const Part& floor) const noexcept {
  if (part.plane == floor.plane || model.planes[floor.plane].height_of(part.low) < kTableM) {
    return false;
  }
  const auto cells_of = [&](const std::vector<Part>& parts) {
    std::size_t cells = 0;
    for (const Part& other : parts) cells += other.plane == part.plane ? other.cells : 0U;
    return cells;
  };
  return cells_of(open_parts_) > cells_of(parts_);
}

// Undersides of shelves are small and have something seen above them somewhere. Of a ceiling in the
// distance each ring of the lidar may show a small part.
void FlatSurfaces::reject_undersides(const Model& model) noexcept {
  const auto is_underside = [&](const Part& part) {
    return model.planes[part.plane].normal.z() < 0.0F && part.cells < kLeastCeilingCells;
  };
  std::array<std::size_t, PlaneSearch::kMostPlanes> cells{};
  for (const Part& part : parts_) cells.at(part.plane) += part.cells;
  std::array<bool, PlaneSearch::kMostPlanes> ceiling{};
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    ceiling.at(k) = cells.at(k) >= kLeastCeilingCells && is_topmost(model, k);
  }
  std::erase_if(parts_, [&](const Part& part) {
    const bool rejected = is_underside(part) && !ceiling.at(part.plane);
    if (rejected) undersides_.push_back(part);
    return rejected;
  });
}

// The undersides of beams: long, with the parts of the same plane in one line, and close under the
// ceiling. Other beams may be as low.
void FlatSurfaces::add_beams(const Model& model) noexcept {
  const auto is_close_to_ceiling = [&](const Part& part) {
    return model.planes[part.plane].normal.z() < -kLevel &&
           part.low.z() >= model.ceiling_z - kBeamHeightM && part.high.z() <= model.ceiling_z;
  };
  for (const Part& part : open_parts_) {
    if (!is_close_to_ceiling(part)) continue;
    Part line = part;
    for (const Part& other : open_parts_) {
      if (is_in_line(line, other)) line.take_in(other);
    }
    if (is_beam(line)) parts_.push_back(part);
  }
  // Of a beam's end, between a wall and the border of the view, all that surrounds it may be
  // hidden.
  const std::size_t found = parts_.size();
  for (const Part& end : undersides_) {
    const auto goes_on = [&](const Part& part) { return is_beam(part) && is_in_line(part, end); };
    const auto last = parts_.begin() + static_cast<std::ptrdiff_t>(found);
    if (is_close_to_ceiling(end) && std::any_of(parts_.begin(), last, goes_on)) {
      parts_.push_back(end);
    }
  }
}

void FlatSurfaces::accept(Model& model, PlaneGrids& grids, const Part& part) noexcept {
  model.planes[part.plane].accepted = true;
  grids.for_each_cell(grids.grid(part.plane), [&](Cell& cell) {
    if (cell.part == part.id) cell.structure = true;
  });
}

void FlatSurfaces::find_levels(Model& model, const Vec3f& origin) noexcept {
  model.floor_z = -std::numeric_limits<float>::infinity();
  model.ceiling_z = std::numeric_limits<float>::infinity();
  for (const Plane& plane : model.planes) {
    if (plane.vertical || !plane.accepted || std::abs(plane.normal.z()) < kLevel ||
        plane.surfels < kLargeSurfels) {
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
  const auto claim = [&](std::int32_t column, std::int32_t row) {
    grids.cell(grid, column, row).part = id;
    part_.push_back({column, row});
  };
  unclaimed_.erase(seed.column, seed.row);
  claim(seed.column, seed.row);
  // The part grows on the way. NOLINTNEXTLINE(modernize-loop-convert)
  for (std::size_t next = 0; next < part_.size(); ++next) {
    const Place at = part_[next];
    unclaimed_.take_around(at.column, at.row, claim);
  }
}

bool FlatSurfaces::bounds_free_space(const PlaneGrids& grids, const PlaneGrid& grid) noexcept {
  const auto is_open = [&](std::int32_t column, std::int32_t row) {
    return grids.cell(grid, column, row).passed >= kPassed ? 1U : 0U;
  };
  ring_.clear();
  std::size_t open_inside = 0;
  std::size_t open_ring = 0;
  for (const Place& at : part_) {
    outside_.erase(at.column, at.row);
    open_inside += is_open(at.column, at.row);
  }
  for (const Place& at : part_) {
    outside_.take_around(at.column, at.row, [&](std::int32_t column, std::int32_t row) {
      ring_.push_back({column, row});
      open_ring += is_open(column, row);
    });
  }
  for (const Place& at : part_) outside_.insert(at.column, at.row);
  for (const Place& at : ring_) outside_.insert(at.column, at.row);
  return static_cast<float>(open_ring) < kMostOpenRing * static_cast<float>(ring_.size()) &&
         static_cast<float>(open_inside) < kMostOpenInside * static_cast<float>(part_.size());
}

}  // namespace convexcut::robust
