// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/slice_worker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/convex_cut/near_boundary.hpp"
#include "core/convex_cut/orientation.hpp"

namespace convexcut {
namespace {

// With more candidates or more rounds of widening, the exact hull of the candidates is quicker. The
// first round leaves few of any number, where it can number them.
constexpr std::size_t kMostCandidates = 1024;
constexpr std::size_t kMostCandidatesAtFirst = std::size_t{1} << 16U;
constexpr int kMostRounds = 6;

}  // namespace

SliceWorker::SliceWorker(const ConvexCutParameters& parameters, std::size_t max_points)
    : half_width_m_(parameters.half_width_m),
      hull_distance_m_(parameters.hull_distance_m),
      u_(max_points + kKernelPadding, 0),
      z_(max_points + kKernelPadding, 1),
      position_(max_points + kKernelPadding, 2),
      near_(max_points + kKernelPadding, 3),
      shallow_u_(max_points + kKernelPadding, 6),
      shallow_z_(max_points + kKernelPadding, 7),
      shallow_position_(max_points + kKernelPadding, 8),
      candidates_(max_points),
      vertices_(max_points + 1),
      hull_u_(max_points + kKernelPadding, 9),
      hull_z_(max_points + kKernelPadding, 10),
      edges_(max_points, 11),
      marks_(max_points + kKernelPadding, 19) {}

void SliceWorker::begin(const ShellIndex& index, float extent_m) noexcept {
  index_ = &index;
  extent_m_ = extent_m;
  tolerance_m_ = kDepthErrorPerExtent * extent_m;
  std::fill_n(marks_.data(), index.size() + kKernelPadding, std::uint8_t{0});
}

void SliceWorker::process(const SlicingPlane& plane, const ShellIndex::Windows& windows) noexcept {
  process_to(0.0F, plane, windows);
  for (const std::uint32_t position : undecided_) {
    if (near_boundary(exact_point(plane, position), hull_, hull_distance_m_)) marks_[position] = 1;
  }
}

void SliceWorker::process_to(float margin_m, const SlicingPlane& plane,
                             const ShellIndex::Windows& windows) noexcept {
  undecided_ = {};
  hull_ = {};
  cut(plane, windows);
  if (count_ == 0) return;
  hull_ = hull_of_members(plane);
  if (hull_.size < 3) {
    keep_all_members();
  } else {
    keep(margin_m);
  }
}

void SliceWorker::cut(const SlicingPlane& plane, const ShellIndex::Windows& windows) noexcept {
  std::array<ShellIndex::Candidates, ShellIndex::kMostRanges> ranges;
  std::size_t range_count = 0;
  index_->for_each_candidate_range(
      windows, [&](const ShellIndex::Candidates& found) { ranges[range_count++] = found; });
  count_ = gather(index_->points(), marks_.span(), std::span(ranges).first(range_count), plane,
                  half_width_m_, extent_m_, members(), stretch_storage_.data());
  stretches_ = std::span(stretch_storage_).first(range_count);
}

SlicePoint SliceWorker::exact_point(const SlicingPlane& plane,
                                    std::uint32_t position) const noexcept {
  const CloudView& sorted = index_->points();
  return plane.project(sorted.x[position], sorted.y[position], sorted.z[position]);
}

// The hull of the slice.
Polygon SliceWorker::hull_of_members(const SlicingPlane& plane) noexcept {
  start_polygon(plane);
  if (polygon_->size() < 3) start_with_any_triangle(plane);
  if (polygon_->size() < 3) return {};
  if (!polygon_->goes_around_once()) {
    for (Stretch& stretch : stretches_) {  // then all edges may face any of them
      stretch.least_u_m = std::numeric_limits<float>::lowest();
      stretch.most_u_m = std::numeric_limits<float>::max();
    }
  }
  set_edges(polygon_->polygon(), edges_.edges);
  std::size_t candidates =
      find_shallow(edges_.edges, edges_.facing, members(), stretches_, tolerance_m_, shallow());
  std::size_t most_candidates = kMostCandidatesAtFirst;
  for (int round = 0; round < kMostRounds && candidates <= most_candidates; ++round) {
    // The corners are candidates themselves. When there are no others, all other members are
    // inside.
    if (candidates == polygon_->size() && polygon_->is_convex()) return polygon_->polygon();
    if (!widen_polygon(plane, candidates)) break;
    set_edges(polygon_->polygon(), edges_.edges);
    candidates = drop_deep(edges_.edges, shallow(), candidates, tolerance_m_);
    most_candidates = kMostCandidates;
  }
  return exact_hull(plane, candidates);
}

// The outermost members in turn.
void SliceWorker::start_polygon(const SlicingPlane& plane) noexcept {
  polygon_->clear();
  const Extremes outermost = extremes(members(), count_);
  std::uint32_t before = outermost.back();
  for (const std::uint32_t member : outermost) {
    polygon_->add_if(exact_point(plane, position_[member] & ~kMarked), member != before);
    before = member;
  }
  polygon_->close();
}

// For a slice whose outermost members are collinear: a triangle of members, or fewer vertices when
// all of them are collinear. Without it, a slice along the axis would sort all of its points.
void SliceWorker::start_with_any_triangle(const SlicingPlane& plane) noexcept {
  std::array<SlicePoint, 3> corners{exact_point(plane, position_[0] & ~kMarked)};
  std::size_t found = 1;
  for (std::size_t i = 1; i < count_ && found < 3; ++i) {
    const SlicePoint point = exact_point(plane, position_[i] & ~kMarked);
    const int turn = found == 1 ? 1 : orientation(corners[0], corners[1], point);
    if (turn == 0 || point == corners[0]) continue;
    corners[found++] = point;
    if (turn < 0) std::swap(corners[1], corners[2]);
  }
  polygon_->clear();
  for (std::size_t k = 0; k < found; ++k) polygon_->add(corners[k]);
  if (found == 3) polygon_->close_exact();
}

// Puts the candidate that is farthest outside of an edge between its corners (W. F. Eddy's and
// A. Bykat's Quickhull, 1977/78). False when there is none, or no room.
bool SliceWorker::widen_polygon(const SlicingPlane& plane, std::size_t candidates) noexcept {
  if (2 * polygon_->size() > InnerPolygon::kMostCorners) return false;
  farthest_outside(edges_.edges, shallow(), candidates, tolerance_m_, farthest_.data());
  wider_polygon_->clear();
  for (std::size_t k = 0; k < polygon_->size(); ++k) {
    const bool is_found = farthest_[k] != kNobody;
    const std::uint32_t farthest = is_found ? farthest_[k] : 0;
    wider_polygon_->add_if(exact_point(plane, shallow_position_[farthest]), is_found);
    wider_polygon_->add(polygon_->corner(k));
  }
  if (wider_polygon_->size() == polygon_->size()) return false;
  wider_polygon_->close();
  std::swap(polygon_, wider_polygon_);
  return true;
}

Polygon SliceWorker::exact_hull(const SlicingPlane& plane, std::size_t count) noexcept {
  for (std::size_t k = 0; k < count; ++k) {
    candidates_[k] = exact_point(plane, shallow_position_[k]);
  }
  const std::span<const SlicePoint> hull =
      convex_hull(std::span(candidates_).first(count), std::span<SlicePoint>(vertices_));
  if (hull.size() < 3) return {};
  double* const u = hull_u_.data() + 1;  // before it, the last vertex again
  double* const z = hull_z_.data() + 1;
  for (std::size_t k = 0; k < hull.size(); ++k) {
    u[k] = hull[k].u;
    z[k] = hull[k].z;
  }
  u[-1] = hull.back().u;
  z[-1] = hull.back().z;
  const Polygon polygon{u, z, hull.size()};
  set_edges(polygon, edges_.edges);
  return polygon;
}

void SliceWorker::keep_all_members() noexcept {
  for (std::size_t i = 0; i < count_; ++i) marks_[position_[i] & ~kMarked] = 1;
}

// Of the hull, edges_ are the edges.
void SliceWorker::keep(float margin_m) noexcept {
  std::uint32_t* const undecided = shallow_position_.data();  // the hull is done with
  const auto e_m = static_cast<float>(hull_distance_m_);
  const std::size_t count =
      mark_near(edges_.edges, edges_.facing, members(), stretches_, e_m - margin_m - tolerance_m_,
                e_m + tolerance_m_, marks_.span(), near_.data(), undecided);
  undecided_ = {undecided, count};
}

}  // namespace convexcut
