// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/second_look.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace convexcut::robust {
namespace {

// Heights over the floor.
constexpr float kTallerThanFurnitureM = 2.4F;
constexpr float kTallerThanPeopleM = 2.3F;
constexpr float kTallerThanBackrestsM = 2.05F;
constexpr float kTallerThanStandsM = 2.6F;  // of a fair
constexpr float kHighestSillM = 1.4F;
constexpr float kFootM = 0.75F;
constexpr float kHighestSliverM = 2.2F;

constexpr float kOverLidarM = 0.9F;
constexpr float kFlat = 1.2F;             // spread², relative to the noise²
constexpr std::uint32_t kTallCells = 10;  // 2.5 m in one column

constexpr float kSliverM = 0.13F;
constexpr float kLeastGone = 0.25F;  // share of cells
constexpr float kWidestGoneM = 2.0F;
constexpr std::uint32_t kSmallCells = 40;  // of a plane, in all
constexpr float kAlongItself = 0.2F;       // squareness
constexpr std::uint32_t kSmallAlongCells = 30;
constexpr float kSquare = 0.9F;
constexpr std::uint32_t kFewCells = 4;
constexpr float kSparse = 8.0F;                 // points of a cell
constexpr std::uint32_t kLeastRevolutions = 3;  // of a sensor at 20 Hz, each has half as many
constexpr float kSmallPlaneM = 3.0F;
constexpr float kMostBehind = 0.5F;  // share of cells

// Of all segments in one plane.
struct InPlane {
  float widest_m = 0.0F;
  std::uint32_t closed = 0;
};

[[nodiscard]] InPlane in_plane_of(const Model& model, std::size_t plane) noexcept {
  InPlane all;
  for (const WallSegment& s : model.segments) {
    if (s.plane != plane) continue;
    all.widest_m = std::max(all.widest_m, s.width_m());
    all.closed += s.closed;
  }
  return all;
}

// The mean of value(cell) over the segment's cells that were seen.
template <class Value>
[[nodiscard]] float mean_of_cells(const PlaneGrids& grids, const WallSegment& s,
                                  Value&& value) noexcept {
  const PlaneGrid& grid = grids.grid(s.plane);
  float sum = 0.0F;
  std::int32_t seen = 0;
  for (std::int32_t c = s.first; c < s.end; ++c) {
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      const Cell& cell = grids.cell(grid, c, row);
      if (cell.seen == 0) continue;
      ++seen;
      sum += static_cast<float>(value(cell));
    }
  }
  return sum / static_cast<float>(std::max(seen, 1));
}

// Of the way from the lidar to its middle: 1 square to it, 0 along it.
[[nodiscard]] float squareness(const Model& model, const PlaneGrids& grids, const WallSegment& s,
                               const Vec3f& lidar) noexcept {
  const Plane& plane = model.planes[s.plane];
  const Vec3f middle =
      grids.grid(s.plane).along * ((s.begin_m + s.end_m) / 2) - plane.normal * plane.offset;
  const float range_m = (middle - lidar).head<2>().norm();
  return std::abs(plane.height_of(lidar)) / std::max(range_m, kCellM);
}

[[nodiscard]] bool rises_above_all(const Model& model, const WallSegment& s, const InPlane& all,
                                   const Vec3f& lidar) noexcept {
  if (s.open > 0 || s.furniture) return false;
  if (s.bottom_m > lidar.z() + kOverLidarM) return true;
  const float top_m = s.top_m - model.floor_z;
  if (all.widest_m < kNarrowM && s.closed >= kTallCells && top_m > kTallerThanPeopleM) return true;
  return !std::isinf(model.ceiling_z) && top_m > kTallerThanFurnitureM &&
         s.spread2 <= kFlat * model.noise2;
}

// What was there and has gone on.
[[nodiscard]] bool is_gone(const PlaneGrids& grids, const WallSegment& s,
                           const InPlane& all) noexcept {
  return s.width_m() < kWidestGoneM && all.closed < kSmallCells &&
         mean_of_cells(grids, s, [](const Cell& cell) { return cell.passed >= kPassed; }) >
             kLeastGone;
}

[[nodiscard]] bool is_sparse(const PlaneGrids& grids, const WallSegment& s,
                             const InPlane& all) noexcept {
  return all.closed <= kSmallCells &&
         mean_of_cells(grids, s, [](const Cell& cell) { return cell.points; }) <= kSparse;
}

// Whether its other columns, that are passed above, may be those beneath a window.
[[nodiscard]] bool may_have_sill(const WallSegment& s, float top_m) noexcept {
  return s.open > s.closed && top_m <= kHighestSillM;
}

[[nodiscard]] bool is_doubtful(const Model& model, const PlaneGrids& grids, const WallSegment& s,
                               const InPlane& all, const Sighting& sighting) noexcept {
  const float top_m = s.top_m - model.floor_z;
  if (top_m < kHighestSliverM && all.widest_m <= kSliverM) return true;
  if (top_m < kTallerThanPeopleM && is_gone(grids, s, all)) return true;
  if (sighting.revolutions >= kLeastRevolutions && top_m < kTallerThanStandsM &&
      is_sparse(grids, s, all)) {
    return true;
  }
  const float square = squareness(model, grids, s, sighting.lidar);
  if (top_m < kTallerThanBackrestsM && square < kAlongItself && all.closed < kSmallAlongCells) {
    return true;
  }
  const bool stands = s.bottom_m - model.floor_z <= kFootM;
  return stands && s.closed <= kFewCells && square <= kSquare && !may_have_sill(s, top_m);
}

}  // namespace

void take_second_look(Model& model, const PlaneGrids& grids, const Sighting& sighting) noexcept {
  if (std::isinf(model.floor_z)) return;
  for (WallSegment& s : model.segments) {
    const InPlane all = in_plane_of(model, s.plane);
    s.accepted = s.accepted ? !is_doubtful(model, grids, s, all, sighting)
                            : rises_above_all(model, s, all, sighting.lidar);
  }
}

void reject_what_is_behind(Model& model, PlaneGrids& grids) noexcept {
  for (WallSegment& s : model.segments) {
    if (!s.accepted || in_plane_of(model, s.plane).widest_m >= kSmallPlaneM) continue;
    const float behind = mean_of_cells(grids, s, [](const Cell& cell) { return cell.before; });
    if (behind <= kMostBehind) continue;
    s.accepted = false;
    const PlaneGrid& grid = grids.grid(s.plane);
    for (std::int32_t c = s.first; c < s.end; ++c) {
      for (std::int32_t row = 0; row < grid.rows; ++row) grids.cell(grid, c, row).structure = false;
    }
  }
}

}  // namespace convexcut::robust
