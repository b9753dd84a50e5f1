// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/kept_slices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/convex_cut/near_boundary.hpp"
#include "core/convex_cut/slice_worker.hpp"

namespace convexcut {
namespace {

// Of e: a greater margin lets hulls grow more, and leaves more points undecided.
constexpr double kMargin = 0.25;

}  // namespace

KeptSlices::KeptSlices(const ConvexCutParameters& parameters)
    : half_width_m_(parameters.half_width_m),
      hull_distance_m_(parameters.hull_distance_m),
      margin_m_(parameters.planes <= kMostPlanes ? kMargin * parameters.hull_distance_m : 0.0),
      slices_(margin_m_ > 0.0 ? parameters.planes : 0),
      facing_normal_u_(KeptHull::kMostCorners + kKernelPadding, 0),
      facing_normal_z_(KeptHull::kMostCorners + kKernelPadding, 1),
      facing_offset_(KeptHull::kMostCorners + kKernelPadding, 2),
      facing_{facing_normal_u_.data(), facing_normal_z_.data(), facing_offset_.data()},
      u_(kMostCandidates + kKernelPadding, 3),
      z_(kMostCandidates + kKernelPadding, 4),
      position_(kMostCandidates + kKernelPadding, 5),
      shallow_u_(kMostCandidates + kKernelPadding, 6),
      shallow_z_(kMostCandidates + kKernelPadding, 7),
      shallow_position_(kMostCandidates + kKernelPadding, 8),
      near_(kMostCandidates + kKernelPadding, 9) {}

bool KeptSlices::keep(std::uint32_t number, const Polygon& hull, float tolerance_m) noexcept {
  Slice& slice = slices_[number];
  const bool has_room = hull.size <= KeptHull::kMostCorners;
  const Polygon kept = has_room ? hull : Polygon{};
  slice.first_size = kept.size;
  std::copy_n(kept.u, kept.size, slice.first_u.begin());
  std::copy_n(kept.z, kept.size, slice.first_z.begin());
  slice.hull.set(kept);
  slice.slack_m = std::max(margin_m_ - static_cast<double>(tolerance_m), 0.0);
  return has_room;
}

bool KeptSlices::add(std::uint32_t number, const SlicingPlane& plane, const Candidates& late,
                     std::span<std::uint8_t> is_undecided, float extent_m) noexcept {
  Slice& slice = slices_[number];
  std::array<Stretch, kMostRanges> all_stretches;
  const std::size_t count = gather(late.points, late.marks, late.ranges, plane, half_width_m_,
                                   extent_m, members(), all_stretches.data());
  if (count == 0) return true;
  if (slice.hull.size() == 0) return false;
  const auto stretches = std::span(all_stretches).first(late.ranges.size());
  const float tolerance_m = kDepthErrorPerExtent * extent_m;
  const std::size_t outside =
      find_shallow(slice.hull.edges(), facing_, members(), stretches, tolerance_m, shallow());
  if (outside != 0 && !grow(slice, plane, late.points, outside)) return false;
  const auto e_m = static_cast<float>(hull_distance_m_);
  const std::uint32_t* const undecided = shallow_position_.data();
  const std::size_t undecided_count =
      mark_near(slice.hull.edges(), facing_, members(), stretches,
                e_m - static_cast<float>(margin_m_) - tolerance_m, e_m + tolerance_m, late.marks,
                near_.data(), shallow_position_.data());
  for (std::size_t i = 0; i < undecided_count; ++i) is_undecided[undecided[i]] = 1;
  return true;
}

// The hull with the members that find_shallow() has found: all that may be outside. False when it
// grows too far.
bool KeptSlices::grow(Slice& slice, const SlicingPlane& plane, const CloudView& late,
                      std::size_t outside) noexcept {
  bool has_grown = false;
  for (std::size_t k = 0; k < outside; ++k) {
    const std::uint32_t i = shallow_position_[k];
    const SlicePoint point = plane.project(late.x[i], late.y[i], late.z[i]);
    if (slice.hull.size() == KeptHull::kMostCorners) return false;
    if (!slice.hull.add(point)) continue;
    if (!near_boundary(point, slice.first(), slice.slack_m)) return false;
    has_grown = true;
  }
  if (has_grown) slice.hull.set_edges();
  return true;
}

void KeptSlices::decide(std::uint32_t number, const SlicingPlane& plane,
                        const Candidates& undecided, float extent_m) noexcept {
  std::array<Stretch, kMostRanges> all_stretches;
  const std::size_t count = gather(undecided.points, undecided.marks, undecided.ranges, plane,
                                   half_width_m_, extent_m, members(), all_stretches.data());
  KeptHull& hull = slices_[number].hull;
  if (count == 0 || hull.size() == 0) return;
  const auto stretches = std::span(all_stretches).first(undecided.ranges.size());
  const float tolerance_m = kDepthErrorPerExtent * extent_m;
  const auto e_m = static_cast<float>(hull_distance_m_);
  std::uint32_t* const doubtful = shallow_position_.data();
  const std::size_t doubtful_count =
      mark_near(hull.edges(), facing_, members(), stretches, e_m - tolerance_m, e_m + tolerance_m,
                undecided.marks, near_.data(), doubtful);
  const auto& [x, y, z] = undecided.points;
  for (const std::uint32_t i : std::span(doubtful, doubtful_count)) {
    const SlicePoint point = plane.project(x[i], y[i], z[i]);
    if (near_boundary(point, hull.polygon(), hull_distance_m_)) undecided.marks[i] = 1;
  }
}

}  // namespace convexcut
