// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/slice_worker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/convex_cut/orientation.hpp"

namespace convexcut {
namespace {

// Bound of the error of a depth estimate, as a part of the cloud's extent X. With |u| ≤ √2·X and
// unit normals, its roundings sum up to less than 1.2e-6·X (design note, section "Tolerance").
constexpr float kDepthErrorPerExtent = 2e-6F;

// A slice of fewer members goes to the hull as it is.
constexpr std::size_t kWorthCulling = 32;

// Fewer candidates for the hull than this are sorted as they are.
constexpr std::size_t kWorthRefining = 16;

// The reference's decision: any edge of the hull within the distance.
[[nodiscard]] bool near_boundary(const SlicePoint& point, std::span<const HullPoint> hull,
                                 double distance_m) noexcept {
  const HullPoint* from = &hull.back();
  for (const HullPoint& to : hull) {
    if (squared_distance(point, *from, to) <= distance_m * distance_m) return true;
    from = &to;
  }
  return false;
}

}  // namespace

SliceWorker::SliceWorker(const ConvexCutParameters& parameters, std::size_t max_points)
    : half_width_m_(parameters.half_width_m),
      hull_distance_m_(parameters.hull_distance_m),
      u_(max_points + kKernelPadding),
      z_(max_points + kKernelPadding),
      depth_(max_points + kKernelPadding),
      position_(max_points + kKernelPadding),
      shallow_u_(max_points + kKernelPadding),
      shallow_z_(max_points + kKernelPadding),
      shallow_depth_(max_points + kKernelPadding),
      shallow_position_(max_points + kKernelPadding),
      candidates_(max_points),
      vertices_(max_points + 1),
      normal_u_(max_points + kKernelPadding),
      normal_z_(max_points + kKernelPadding),
      edge_offset_(max_points + kKernelPadding),
      edges_{normal_u_.data(), normal_z_.data(), edge_offset_.data()},
      marks_(max_points + kKernelPadding) {}

void SliceWorker::begin(const ShellIndex& index, float extent_m) noexcept {
  index_ = &index;
  extent_m_ = extent_m;
  tolerance_m_ = kDepthErrorPerExtent * extent_m;
  std::fill_n(marks_.begin(), index.points().size() + kKernelPadding, std::uint8_t{0});
}

void SliceWorker::process(const SlicingPlane& plane, const ShellIndex::Windows& windows) noexcept {
  cut(plane, windows);
  keep(plane, hull_of_members(plane));
}

void SliceWorker::cut(const SlicingPlane& plane, const ShellIndex::Windows& windows) noexcept {
  std::array<ShellIndex::Range, 2 * ShellIndex::kShells> ranges;
  std::size_t range_count = 0;
  index_->for_each_candidate_range(windows,
                                   [&](ShellIndex::Range range) { ranges[range_count++] = range; });
  count_ = gather(index_->points(), marks_, std::span(ranges).first(range_count), plane,
                  half_width_m_, extent_m_, members());
}

HullPoint SliceWorker::exact_point(const SlicingPlane& plane,
                                   std::uint32_t position) const noexcept {
  const CloudView& sorted = index_->points();
  return {plane.project(sorted.x[position], sorted.y[position], sorted.z[position]), position};
}

SliceWorker::Hull SliceWorker::exact_hull(const SlicingPlane& plane, std::size_t count) noexcept {
  for (std::size_t k = 0; k < count; ++k) {
    candidates_[k] = exact_point(plane, shallow_position_[k]);
  }
  return convex_hull(std::span(candidates_).first(count), std::span<HullPoint>(vertices_));
}

// The hull of the slice; leaves the members that the slice may still make structure.
SliceWorker::Hull SliceWorker::hull_of_members(const SlicingPlane& plane) noexcept {
  if (count_ < kWorthCulling) {
    for (std::size_t i = 0; i < count_; ++i) shallow_position_[i] = position_[i] & ~kMarked;
    return exact_hull(plane, count_);
  }
  Polygon polygon = outermost_polygon(plane);
  if (polygon.size() < 3) polygon = any_triangle(plane);
  if (polygon.size() < 3) return {};  // degenerate: all members are kept
  set_edges(polygon, edges_);
  std::size_t candidates =
      depths(edges_, members(), count_, tolerance_m_, depth_.data(), shallow());
  count_ = drop_deep(depth_.data(), static_cast<float>(hull_distance_m_) + tolerance_m_, members(),
                     count_);
  if (candidates > kWorthRefining) {
    set_edges(refined_polygon(plane, candidates), edges_);
    candidates =
        depths(edges_, shallow(), candidates, tolerance_m_, shallow_depth_.data(), shallow());
  }
  return exact_hull(plane, candidates);
}

// Leaves out corners that repeat or turn inwards. Any closed chain is right; one that winds about
// less leaves more to the exact hull.
SliceWorker::Polygon SliceWorker::without_dents(std::size_t size) noexcept {
  const auto turns_left = [](const SlicePoint& a, const SlicePoint& b, const SlicePoint& c) {
    return (b.u - a.u) * (c.z - a.z) - (b.z - a.z) * (c.u - a.u) > 0.0;
  };
  std::size_t left = 0;
  for (std::size_t k = 0; k < size; ++k) {
    const HullPoint corner = corners_[k];
    while (left >= 2 && !turns_left(corners_[left - 2], corners_[left - 1], corner)) --left;
    if (left == 0 || corner != corners_[left - 1]) corners_[left++] = corner;
  }
  while (left > 2 && !turns_left(corners_[left - 2], corners_[left - 1], corners_[0])) --left;
  return std::span(corners_).first(left);
}

// The outermost members in turn.
SliceWorker::Polygon SliceWorker::outermost_polygon(const SlicingPlane& plane) noexcept {
  const Extremes outer = extremes(members(), count_, Directions::coarse);
  for (std::size_t k = 0; k < kExtremes; ++k) {
    outermost_[k] = exact_point(plane, position_[outer[k]] & ~kMarked);
    corners_[k] = outermost_[k];
  }
  return without_dents(kExtremes);
}

SliceWorker::Polygon SliceWorker::refined_polygon(const SlicingPlane& plane,
                                                  std::size_t candidates) noexcept {
  const Extremes outer = extremes(shallow(), candidates, Directions::fine);
  for (std::size_t k = 0; k < kExtremes; ++k) {
    corners_[2 * k] = outermost_[k];
    corners_[2 * k + 1] = exact_point(plane, shallow_position_[outer[k]]);
  }
  return without_dents(2 * kExtremes);
}

// For a slice whose outermost members are collinear: a triangle of members, or fewer vertices when
// all of them are collinear. Without it, a slice along the axis would sort all of its points.
SliceWorker::Polygon SliceWorker::any_triangle(const SlicingPlane& plane) noexcept {
  corners_[0] = exact_point(plane, position_[0] & ~kMarked);
  std::size_t found = 1;
  for (std::size_t i = 1; i < count_ && found < 3; ++i) {
    const HullPoint point = exact_point(plane, position_[i] & ~kMarked);
    const int turn = found == 1 ? 1 : orientation(corners_[0], corners_[1], point);
    if (turn == 0 || point == corners_[0]) continue;
    corners_[found++] = point;
    if (turn < 0) std::swap(corners_[1], corners_[2]);
  }
  return std::span(corners_).first(found);
}

void SliceWorker::keep(const SlicingPlane& plane, Hull hull) noexcept {
  if (hull.size() < 3) {
    for (std::size_t i = 0; i < count_; ++i) marks_[position_[i] & ~kMarked] = 1;
    return;
  }
  set_edges(hull, edges_);
  const std::size_t doubtful = mark_near(
      edges_, members(), count_, static_cast<float>(hull_distance_m_), tolerance_m_, marks_);
  for (std::size_t i = 0; i < doubtful; ++i) {
    const std::uint32_t position = position_[i];
    if (near_boundary(exact_point(plane, position), hull, hull_distance_m_)) marks_[position] = 1;
  }
}

}  // namespace convexcut
