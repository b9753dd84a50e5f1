// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/slice_worker.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/convex_cut/convex_hull.hpp"
#include "core/convex_cut/orientation.hpp"

namespace convexcut {
namespace {

// Bound of the error of a depth estimate, as a part of the cloud's extent X. With |u| ≤ √2·X and
// unit normals, its roundings sum up to less than 0.9e-6·X (design note, section "Tolerance").
constexpr float kDepthErrorPerExtent = 2e-6F;

// A slice of fewer members goes to the hull as it is.
constexpr std::size_t kWorthCulling = 32;

// Several workers set the same flag to the same value, and read it only to save themselves work.
// Relaxed: it orders nothing; the end of the parallel section publishes the flags.
void set_flag(std::uint8_t& flag) noexcept {
  std::atomic_ref(flag).store(1, std::memory_order_relaxed);
}
[[nodiscard]] bool is_set(std::uint8_t& flag) noexcept {  // C++20's atomic_ref takes no const
  return std::atomic_ref(flag).load(std::memory_order_relaxed) != 0;
}

[[nodiscard]] SlicePoint exact_point(const CloudView& sorted, const SlicingPlane& plane,
                                     std::uint32_t position) noexcept {
  return plane.project(sorted.x[position], sorted.y[position], sorted.z[position]);
}

// The reference's decision: any edge of the hull within the distance.
[[nodiscard]] bool near_boundary(const SlicePoint& point, std::span<const SlicePoint> hull,
                                 double distance_m) noexcept {
  const SlicePoint* from = &hull.back();
  for (const SlicePoint& to : hull) {
    if (squared_distance(point, *from, to) <= distance_m * distance_m) return true;
    from = &to;
  }
  return false;
}

}  // namespace

SliceWorker::SliceWorker(const ConvexCutParameters& parameters, std::size_t max_points)
    : half_width_m_(parameters.half_width_m),
      hull_distance_m_(parameters.hull_distance_m),
      u_(max_points + kKernelBlock),
      z_(max_points + kKernelBlock),
      depth_(max_points + kKernelBlock),
      position_(max_points + kKernelBlock),
      candidate_position_(max_points + 1),
      candidates_(std::max(max_points, kExtremes)),
      vertices_(std::max(max_points, kExtremes) + 1),
      normal_u_(std::max(max_points, kExtremes)),
      normal_z_(std::max(max_points, kExtremes)),
      edge_offset_(std::max(max_points, kExtremes)) {}

void SliceWorker::process(const ShellIndex& index, const SlicingPlane& plane,
                          const ShellIndex::Windows& windows, float extent_m,
                          std::span<std::uint8_t> structure) noexcept {
  tolerance_m_ = kDepthErrorPerExtent * extent_m;
  const CloudView sorted = index.points();
  cut(index, plane, windows);
  const std::size_t candidates = select(sorted, plane, structure);
  const Hull hull = convex_hull(std::span(candidates_).first(candidates), vertices_);
  keep(sorted, plane, hull, structure);
}

void SliceWorker::cut(const ShellIndex& index, const SlicingPlane& plane,
                      const ShellIndex::Windows& windows) noexcept {
  const CloudView sorted = index.points();
  count_ = 0;
  index.for_each_candidate_range(windows, [&](ShellIndex::Range range) {
    count_ = gather(sorted, range, plane, half_width_m_, members(), count_);
  });
}

SliceWorker::Hull SliceWorker::inscribed_polygon(const CloudView& sorted,
                                                 const SlicingPlane& plane) noexcept {
  const std::array<std::size_t, kExtremes> outer = extremes(members(), count_);
  for (std::size_t k = 0; k < kExtremes; ++k) {
    candidates_[k] = exact_point(sorted, plane, position_[outer[k]]);
  }
  const Hull polygon = convex_hull(std::span(candidates_).first(kExtremes), vertices_);
  return polygon.size() >= 3 ? polygon : any_triangle(sorted, plane);
}

// For a slice whose outermost members are collinear: a triangle of members, or fewer vertices when
// all of them are collinear. Without it, a slice along the axis would sort all of its points.
SliceWorker::Hull SliceWorker::any_triangle(const CloudView& sorted,
                                            const SlicingPlane& plane) noexcept {
  std::array<SlicePoint, 3> corners{exact_point(sorted, plane, position_[0])};
  std::size_t found = 1;
  for (std::size_t i = 1; i < count_ && found < corners.size(); ++i) {
    const SlicePoint point = exact_point(sorted, plane, position_[i]);
    const bool extends =
        found == 1 ? point != corners[0] : orientation(corners[0], corners[1], point) != 0;
    if (extends) corners[found++] = point;
  }
  return convex_hull(std::span(corners).first(found), vertices_);
}

// Leaves the members that this slice may still make structure, and returns how many candidates for
// the hull it has written.
std::size_t SliceWorker::select(const CloudView& sorted, const SlicingPlane& plane,
                                std::span<std::uint8_t> structure) noexcept {
  if (count_ < kWorthCulling) {
    for (std::size_t i = 0; i < count_; ++i) {
      candidates_[i] = exact_point(sorted, plane, position_[i]);
    }
    return count_;
  }
  const Hull polygon = inscribed_polygon(sorted, plane);
  if (polygon.size() < 3) return 0;  // no candidates, a degenerate hull: all members are kept
  set_edges(polygon);
  depth_within(edges(), polygon.size(), members(), count_, depth_.data());
  const float reach_m = static_cast<float>(hull_distance_m_) + tolerance_m_;
  std::size_t undecided = 0;
  std::size_t candidates = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    // Written in any case and kept if it counts: whether it does cannot be predicted.
    const std::uint32_t position = position_[i];
    candidate_position_[candidates] = position;
    candidates += static_cast<std::size_t>(depth_[i] <= tolerance_m_);
    u_[undecided] = u_[i];
    z_[undecided] = z_[i];
    position_[undecided] = position;
    const bool open = !is_set(structure[position]);
    undecided += static_cast<std::size_t>(open && depth_[i] <= reach_m);
  }
  for (std::size_t k = 0; k < candidates; ++k) {
    candidates_[k] = exact_point(sorted, plane, candidate_position_[k]);
  }
  count_ = undecided;
  return candidates;
}

void SliceWorker::keep(const CloudView& sorted, const SlicingPlane& plane, Hull hull,
                       std::span<std::uint8_t> structure) noexcept {
  if (hull.size() < 3) {
    for (std::size_t i = 0; i < count_; ++i) set_flag(structure[position_[i]]);
    return;
  }
  set_edges(hull);
  depth_within(edges(), hull.size(), members(), count_, depth_.data());
  const auto e = static_cast<float>(hull_distance_m_);
  for (std::size_t i = 0; i < count_; ++i) {
    if (depth_[i] > e + tolerance_m_) continue;
    const std::uint32_t position = position_[i];
    if (depth_[i] < e - tolerance_m_ ||
        near_boundary(exact_point(sorted, plane, position), hull, hull_distance_m_)) {
      set_flag(structure[position]);
    }
  }
}

void SliceWorker::set_edges(Hull polygon) noexcept {
  SlicePoint from = polygon.back();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const SlicePoint to = polygon[k];
    const double edge_u = to.u - from.u;
    const double edge_z = to.z - from.z;
    const double length = std::sqrt(edge_u * edge_u + edge_z * edge_z);
    // Counter-clockwise: the inside is on the left.
    const double normal_u = -edge_z / length;
    const double normal_z = edge_u / length;
    normal_u_[k] = static_cast<float>(normal_u);
    normal_z_[k] = static_cast<float>(normal_z);
    edge_offset_[k] = static_cast<float>(normal_u * to.u + normal_z * to.z);
    from = to;
  }
}

}  // namespace convexcut
