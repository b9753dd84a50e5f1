// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/second_look.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace convexcut::robust {
namespace {

// Heights over the floor.
constexpr float kTallerThanPeopleM = 2.3F;
constexpr float kTallerThanBackrestsM = 2.05F;
constexpr float kTallerThanStandsM = 2.6F;  // of a fair
constexpr float kHighestSillM = 1.4F;
constexpr float kFootM = 0.75F;
constexpr float kHighestSliverM = 2.2F;

constexpr float kOverLidarM = 0.9F;
constexpr std::uint32_t kTallCells = 10;  // 2.5 m in one column

constexpr float kSliverM = 0.13F;
constexpr float kLeastGone = 0.25F;  // share of cells
constexpr float kWidestGoneM = 2.0F;
constexpr std::uint32_t kSmallCells = 40;  // of a plane, in all
constexpr std::uint32_t kSmallLowCells = 24;
constexpr float kAlongItself = 0.2F;  // squareness
constexpr std::uint32_t kSmallAlongCells = 30;
constexpr float kSquare = 0.9F;
constexpr std::uint32_t kFewCells = 4;
constexpr float kSparse = 8.0F;                 // points of a cell
constexpr std::uint32_t kLeastRevolutions = 3;  // of a sensor at 20 Hz, each has half as many
constexpr float kSmallPlaneM = 3.0F;
constexpr float kMostBehind = 0.5F;  // share of cells
constexpr std::uint32_t kSmallBehindCells = 28;
constexpr float kMostBehindOfSmall = 0.375F;

// Of all segments in one plane.
struct InPlane {
  float widest_m = 0.0F;
  std::uint32_t closed = 0;
};

// visit(segment, all of its plane). They are there plane by plane.
template <class Visit>
void for_each_segment(std::span<WallSegment> segments, Visit&& visit) noexcept {
  while (!segments.empty()) {
    const std::size_t plane = segments.front().plane;
    const auto end = std::find_if(segments.begin(), segments.end(),
                                  [&](const WallSegment& s) { return s.plane != plane; });
    const auto count = static_cast<std::size_t>(end - segments.begin());
    InPlane all;
    for (const WallSegment& s : segments.first(count)) {
      all.widest_m = std::max(all.widest_m, s.width_m());
      all.closed += s.closed;
    }
    for (WallSegment& s : segments.first(count)) visit(s, all);
    segments = segments.subspan(count);
  }
}

// The mean of value(cell) over the segment's cells that were seen.
template <class Value>
[[nodiscard]] float mean_of_cells(const PlaneGrids& grids, const WallSegment& s,
                                  Value&& value) noexcept {
  float sum = 0.0F;
  std::int32_t seen = 0;
  grids.for_each_cell(s, [&](const Cell& cell) {
    if (cell.seen == 0) return;
    ++seen;
    sum += static_cast<float>(value(cell));
  });
  return sum / static_cast<float>(std::max(seen, 1));
}

// Of the way from the lidar to its middle: 1 square to it, 0 along it.
[[nodiscard]] float squareness(const Model& model, const WallSegment& s,
                               const Vec3f& lidar) noexcept {
  const Plane& plane = model.planes[s.plane];
  const float range_m = (point_of(plane, s.middle_m()) - lidar).head<2>().norm();
  return std::abs(plane.height_of(lidar)) / std::max(range_m, kCellM);
}

[[nodiscard]] bool rises_above_all(const Model& model, const WallSegment& s, const InPlane& all,
                                   const Vec3f& lidar) noexcept {
  if (s.open > 0 || s.furniture) return false;
  if (s.bottom_m > lidar.z() + kOverLidarM) return true;
  const float top_m = s.top_m - model.floor_z;
  if (all.widest_m < kNarrowM && s.closed >= kTallCells && top_m > kTallerThanPeopleM) return true;
  return !std::isinf(model.ceiling_z) && top_m > kTallerThanFurnitureM &&
         s.spread2 <= kFlatFace * model.noise2;
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

// Of a few cells alone it tells less than from where they were seen.
[[nodiscard]] bool is_low(const WallSegment& s, const InPlane& all, float top_m) noexcept {
  return top_m < kLowM && all.closed > kFewCells && all.closed <= kSmallLowCells &&
         !may_have_sill(s, top_m);
}

[[nodiscard]] bool is_doubtful(const Model& model, const PlaneGrids& grids, const WallSegment& s,
                               const InPlane& all, const Sighting& sighting) noexcept {
  const float top_m = s.top_m - model.floor_z;
  if (top_m < kHighestSliverM && all.widest_m <= kSliverM) return true;
  if (is_low(s, all, top_m)) return true;
  if (top_m < kTallerThanPeopleM && is_gone(grids, s, all)) return true;
  if (sighting.revolutions >= kLeastRevolutions && top_m < kTallerThanStandsM &&
      is_sparse(grids, s, all)) {
    return true;
  }
  const float square = squareness(model, s, sighting.lidar);
  if (top_m < kTallerThanBackrestsM && square < kAlongItself && all.closed < kSmallAlongCells) {
    return true;
  }
  const bool stands = s.bottom_m - model.floor_z <= kFootM;
  return stands && s.closed <= kFewCells && square <= kSquare && !may_have_sill(s, top_m);
}

}  // namespace

void take_second_look(Model& model, const PlaneGrids& grids, const Sighting& sighting) noexcept {
  if (std::isinf(model.floor_z)) return;
  for_each_segment(model.segments, [&](WallSegment& s, const InPlane& all) {
    s.accepted = s.accepted ? !is_doubtful(model, grids, s, all, sighting)
                            : rises_above_all(model, s, all, sighting.lidar);
  });
}

void reject_what_is_behind(Model& model, PlaneGrids& grids) noexcept {
  for_each_segment(model.segments, [&](WallSegment& s, const InPlane& all) {
    if (!s.accepted || all.widest_m >= kSmallPlaneM) return;
    const float behind = mean_of_cells(grids, s, [](const Cell& cell) { return cell.before; });
    const bool small =
        all.closed <= kSmallBehindCells && s.top_m - model.floor_z < kTallerThanFurnitureM;
    if (behind <= (small ? kMostBehindOfSmall : kMostBehind)) return;
    s.accepted = false;
    grids.for_each_cell(s, [](Cell& cell) { cell.structure = false; });
  });
}

}  // namespace convexcut::robust
