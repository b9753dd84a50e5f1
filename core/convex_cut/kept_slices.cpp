// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/kept_slices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/convex_cut/near_boundary.hpp"
#include "core/convex_cut/slice_worker.hpp"

namespace convexcut {
namespace {

// Of e: a greater margin lets hulls grow more, and leaves more points undecided.
constexpr double kMargin = 0.25;

constexpr float kAnywhereM = std::numeric_limits<float>::max();

[[nodiscard]] Stretch all_of(std::size_t count) noexcept {
  return {0, static_cast<std::uint32_t>(count), -kAnywhereM, kAnywhereM};
}

}  // namespace

KeptSlices::KeptSlices(const ConvexCutParameters& parameters)
    : half_width_m_(parameters.half_width_m),
      hull_distance_m_(parameters.hull_distance_m),
      margin_m_(parameters.planes <= kMostPlanes ? kMargin * parameters.hull_distance_m : 0.0),
      slices_(margin_m_ > 0.0 ? parameters.planes : 0),
      hull_u_(1 + kMostCorners + kKernelPadding, 0),
      hull_z_(1 + kMostCorners + kKernelPadding, 1),
      edges_(kMostCorners, 2),
      u_(kMostLate + kKernelPadding, 10),
      z_(kMostLate + kKernelPadding, 11),
      position_(kMostLate + kKernelPadding, 12),
      shallow_u_(kMostLate + kKernelPadding, 13),
      shallow_z_(kMostLate + kKernelPadding, 14),
      shallow_position_(kMostLate + kKernelPadding, 15),
      near_(kMostLate + kKernelPadding, 16),
      marks_(kMostLate + kKernelPadding, 17),
      undecided_(kMostUndecided),
      candidates_(kMostCorners + kMostLate),
      vertices_(kMostCorners + kMostLate + 1) {}

bool KeptSlices::keep(std::uint32_t number, const Polygon& hull,
                      std::span<const std::uint32_t> undecided, float tolerance_m) noexcept {
  Slice& slice = slices_[number];
  slice.corner_count = slice.undecided_count = 0;
  if (hull.size > kMostCorners || undecided.size() > kMostUndecided) return false;
  slice.corner_count = hull.size;
  slice.undecided_count = undecided.size();
  slice.slack_m = margin_m_ - static_cast<double>(tolerance_m);
  for (std::size_t k = 0; k < hull.size; ++k) slice.corners[k] = {hull.u[k], hull.z[k]};
  std::ranges::copy(undecided, slice.undecided.begin());
  return true;
}

void KeptSlices::load_hull(const Slice& slice) noexcept {
  hull_size_ = slice.corner_count;
  for (std::size_t k = 0; k < hull_size_; ++k) {
    hull_u_[k + 1] = slice.corners[k].u;
    hull_z_[k + 1] = slice.corners[k].z;
  }
  hull_u_[0] = hull_u_[hull_size_];
  hull_z_[0] = hull_z_[hull_size_];
  set_edges(hull(), edges_.edges);
}

void KeptSlices::decide(std::uint32_t number, const SlicingPlane& plane, const CloudView& cloud,
                        float extent_m, std::span<std::uint8_t> counts) noexcept {
  const Slice& slice = slices_[number];
  std::size_t count = 0;
  for (const std::uint32_t point : std::span(slice.undecided).first(slice.undecided_count)) {
    undecided_[count] = point;
    count += counts[point] == 0 ? 1U : 0U;
  }
  if (count == 0) return;
  const auto exact_point = [&](std::size_t k) {
    const std::uint32_t point = undecided_[k];
    return plane.project(cloud.x[point], cloud.y[point], cloud.z[point]);
  };
  for (std::size_t k = 0; k < count; ++k) {
    const SlicePoint point = exact_point(k);
    u_[k] = static_cast<float>(point.u);
    z_[k] = static_cast<float>(point.z);
    position_[k] = static_cast<std::uint32_t>(k);
    marks_[k] = 0;
  }
  load_hull(slice);
  const float tolerance_m = kDepthErrorPerExtent * extent_m;
  const auto e_m = static_cast<float>(hull_distance_m_);
  const Stretch all = all_of(count);
  std::uint32_t* const doubtful = shallow_position_.data();
  const std::size_t doubtful_count =
      mark_near(edges_.edges, edges_.facing, members(), {&all, 1}, e_m - tolerance_m,
                e_m + tolerance_m, marks_.span(), near_.data(), doubtful);
  for (std::size_t i = 0; i < doubtful_count; ++i) {
    if (near_boundary(exact_point(doubtful[i]), hull(), hull_distance_m_)) marks_[doubtful[i]] = 1;
  }
  for (std::size_t k = 0; k < count; ++k) counts[undecided_[k]] = marks_[k];
}

double KeptSlices::distance_outside(const SlicePoint& point) const noexcept {
  double squared = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k <= hull_size_; ++k) {
    squared = std::min(squared, squared_distance(point, {hull_u_[k - 1], hull_z_[k - 1]},
                                                 {hull_u_[k], hull_z_[k]}));
  }
  return std::sqrt(squared);
}

// The hull with the members that find_shallow() has found: all that may be outside. False when it
// grows too far.
bool KeptSlices::grow(Slice& slice, const SlicingPlane& plane, const Late& late,
                      std::size_t candidates, float tolerance_m) noexcept {
  std::size_t count = 0;
  for (std::size_t k = 0; k < slice.corner_count; ++k) {
    candidates_[count++] = {slice.corners[k], kNobody};
  }
  for (std::size_t k = 0; k < candidates; ++k) {
    const std::uint32_t i = shallow_position_[k];
    candidates_[count++] = {plane.project(late.columns.x[i], late.columns.y[i], late.columns.z[i]),
                            i};
  }
  const std::span<const HullPoint> hull =
      convex_hull(std::span(candidates_).first(count), std::span(vertices_));
  double growth_m = -1.0;
  for (const HullPoint& vertex : hull) {
    if (vertex.position != kNobody) growth_m = std::max(growth_m, distance_outside(vertex));
  }
  if (growth_m < 0.0) return true;
  slice.slack_m -= growth_m + static_cast<double>(tolerance_m);
  if (slice.slack_m < 0.0 || hull.size() > kMostCorners) return false;
  slice.corner_count = hull.size();
  std::ranges::copy(hull, slice.corners.begin());
  load_hull(slice);
  return true;
}

bool KeptSlices::add(std::uint32_t number, const SlicingPlane& plane, const Late& late,
                     float extent_m) noexcept {
  Slice& slice = slices_[number];
  const auto late_count = static_cast<std::uint32_t>(late.points.size());
  const ShellIndex::Candidates anywhere{{0, late_count}, -kAnywhereM, kAnywhereM};
  Stretch all;
  const std::size_t count = gather(late.columns, late.marks, {&anywhere, 1}, plane, half_width_m_,
                                   extent_m, members(), &all);
  if (count == 0) return true;
  if (slice.corner_count == 0) return false;
  const float tolerance_m = kDepthErrorPerExtent * extent_m;
  load_hull(slice);
  const std::size_t outside =
      find_shallow(edges_.edges, edges_.facing, members(), {&all, 1}, tolerance_m, shallow());
  if (outside != 0 && !grow(slice, plane, late, outside, tolerance_m)) return false;
  const auto e_m = static_cast<float>(hull_distance_m_);
  const std::uint32_t* const undecided = shallow_position_.data();
  const std::size_t undecided_count =
      mark_near(edges_.edges, edges_.facing, members(), {&all, 1},
                e_m - static_cast<float>(margin_m_) - tolerance_m, e_m + tolerance_m, late.marks,
                near_.data(), shallow_position_.data());
  if (slice.undecided_count + undecided_count > kMostUndecided) return false;
  for (std::size_t i = 0; i < undecided_count; ++i) {
    slice.undecided[slice.undecided_count++] = late.points[undecided[i]];
  }
  return true;
}

}  // namespace convexcut
