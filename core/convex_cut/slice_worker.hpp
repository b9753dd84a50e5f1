// SPDX-License-Identifier: Apache-2.0
//
// One slice from cut to keep: what a thread of ConvexCutEngine does, with its own workspace.
//
// Most points are decided by estimates in float whose error is bounded by a tolerance; only those
// that the estimates leave undecided get the reference's double expression. Nothing is decided
// differently from the reference, there are only fewer evaluations:
//  - a polygon whose vertices are members of the slice lies within the hull, so a point that is
//    deeper than e within it is not structure by this slice, and one that is strictly within it is
//    no vertex of the hull (Akl and Toussaint 1978);
//  - a point that another slice made structure needs no decision, only its part in the hull.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_cut/convex_hull.hpp"
#include "core/convex_cut/parameters.hpp"
#include "core/convex_cut/shell_index.hpp"
#include "core/convex_cut/slice_kernels.hpp"
#include "core/convex_cut/slicing_plane.hpp"
#include "core/workspace.hpp"

namespace convexcut {

class SliceWorker {
 public:
  // Allocates 64 bytes a point: a slice can hold the whole cloud, and all of it be hull.
  SliceWorker(const ConvexCutParameters& parameters, std::size_t max_points);

  // Sets structure[position] = 1 for the members of the plane's slice that are structure. Several
  // workers may work on one index and one `structure` at the same time. extent_m: the greatest
  // magnitude of a coordinate. RT: no allocation, no lock, no system call.
  void process(const ShellIndex& index, const SlicingPlane& plane,
               const ShellIndex::Windows& windows, float extent_m,
               std::span<std::uint8_t> structure) noexcept;

 private:
  using Hull = std::span<const SlicePoint>;

  void cut(const ShellIndex& index, const SlicingPlane& plane,
           const ShellIndex::Windows& windows) noexcept;
  [[nodiscard]] Hull inscribed_polygon(const CloudView& sorted, const SlicingPlane& plane) noexcept;
  [[nodiscard]] Hull any_triangle(const CloudView& sorted, const SlicingPlane& plane) noexcept;
  [[nodiscard]] std::size_t select(const CloudView& sorted, const SlicingPlane& plane,
                                   std::span<std::uint8_t> structure) noexcept;
  void keep(const CloudView& sorted, const SlicingPlane& plane, Hull hull,
            std::span<std::uint8_t> structure) noexcept;
  void set_edges(Hull polygon) noexcept;

  [[nodiscard]] SliceColumns members() noexcept { return {u_.data(), z_.data(), position_.data()}; }
  [[nodiscard]] EdgeColumns edges() noexcept {
    return {normal_u_.data(), normal_z_.data(), edge_offset_.data()};
  }

  double half_width_m_;
  double hull_distance_m_;
  float tolerance_m_ = 0.0F;  // of depths, for the cloud at hand

  std::size_t count_ = 0;  // members; after select() those that are still to be decided
  Workspace<float> u_, z_, depth_;
  Workspace<std::uint32_t> position_;
  Workspace<std::uint32_t> candidate_position_;
  Workspace<SlicePoint> candidates_;  // for vertices of the hull
  Workspace<SlicePoint> vertices_;
  Workspace<float> normal_u_, normal_z_, edge_offset_;
};

}  // namespace convexcut
