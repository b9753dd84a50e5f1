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

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_cut/column.hpp"
#include "core/convex_cut/convex_hull.hpp"
#include "core/convex_cut/edge_workspace.hpp"
#include "core/convex_cut/inner_polygon.hpp"
#include "core/convex_cut/parameters.hpp"
#include "core/convex_cut/polygon_kernels.hpp"
#include "core/convex_cut/shell_index.hpp"
#include "core/convex_cut/slice_kernels.hpp"
#include "core/convex_cut/slicing_plane.hpp"
#include "core/workspace.hpp"

namespace convexcut {

// Bound of the error of a depth estimate, as a part of the cloud's extent X. With |u| ≤ √2·X and
// unit normals, its roundings sum up to less than 1.2e-6·X (design note, section "Tolerance").
inline constexpr float kDepthErrorPerExtent = 2e-6F;

class SliceWorker {
 public:
  // Allocates 110 bytes a point: a slice can hold the whole cloud, and all of it be hull.
  SliceWorker(const ConvexCutParameters& parameters, std::size_t max_points);

  // Before the first slice of a cloud. extent_m: the greatest magnitude of a coordinate.
  void begin(const ShellIndex& index, float extent_m) noexcept;
  [[nodiscard]] bool has_begun() const noexcept { return index_ != nullptr; }
  // The cloud is done with.
  void forget() noexcept { index_ = nullptr; }

  // Finds the members of the plane's slice that are structure. The planes of a cloud may come in
  // any order; neighbours after each other are quickest. RT: no allocation, no lock, no system
  // call.
  void process(const SlicingPlane& plane, const ShellIndex::Windows& windows) noexcept;

  // The same, but the members that are between e − margin_m and e from the hull's boundary are left
  // undecided, as far as no slice has made them structure. See KeptSlices.
  void process_to(float margin_m, const SlicingPlane& plane,
                  const ShellIndex::Windows& windows) noexcept;
  // Until the next slice: positions in the index, and the hull; no corners where it has fewer than
  // three vertices.
  [[nodiscard]] std::span<const std::uint32_t> undecided() const noexcept { return undecided_; }
  [[nodiscard]] Polygon hull() const noexcept { return hull_.size < 3 ? Polygon{} : hull_; }
  [[nodiscard]] float tolerance_m() const noexcept { return tolerance_m_; }

  // By position in the index: 1 where a slice since begin() made the point structure.
  [[nodiscard]] std::span<std::uint8_t> marks() noexcept { return marks_.span(); }

 private:
  void cut(const SlicingPlane& plane, const ShellIndex::Windows& windows) noexcept;
  [[nodiscard]] Polygon hull_of_members(const SlicingPlane& plane) noexcept;
  void start_polygon(const SlicingPlane& plane) noexcept;
  void start_with_any_triangle(const SlicingPlane& plane) noexcept;
  [[nodiscard]] bool widen_polygon(const SlicingPlane& plane, std::size_t candidates) noexcept;
  [[nodiscard]] Polygon exact_hull(const SlicingPlane& plane, std::size_t count) noexcept;
  void keep(float margin_m) noexcept;
  void keep_all_members() noexcept;
  [[nodiscard]] SlicePoint exact_point(const SlicingPlane& plane,
                                       std::uint32_t position) const noexcept;

  [[nodiscard]] SliceColumns members() noexcept { return {u_.data(), z_.data(), position_.data()}; }
  [[nodiscard]] SliceColumns shallow() noexcept {
    return {shallow_u_.data(), shallow_z_.data(), shallow_position_.data()};
  }

  double half_width_m_;
  double hull_distance_m_;

  const ShellIndex* index_ = nullptr;  // of the cloud at hand
  float extent_m_ = 0.0F;
  float tolerance_m_ = 0.0F;  // of depths

  std::size_t count_ = 0;  // members
  Column<float> u_, z_;
  Column<std::uint32_t> position_;
  std::array<Stretch, ShellIndex::kMostRanges> stretch_storage_{};
  std::span<Stretch> stretches_;
  Polygon hull_;
  std::span<const std::uint32_t> undecided_;
  Column<std::uint32_t> near_;  // positions of members that the slice makes structure
  // Members that may be vertices of the hull.
  Column<float> shallow_u_, shallow_z_;
  Column<std::uint32_t> shallow_position_;
  std::array<InnerPolygon, 2> polygons_;
  InnerPolygon* polygon_ = polygons_.data();
  InnerPolygon* wider_polygon_ = polygons_.data() + 1;
  std::array<std::uint32_t, InnerPolygon::kMostCorners + kKernelPadding> farthest_{};
  Workspace<SlicePoint> candidates_;
  Workspace<SlicePoint> vertices_;
  Column<double> hull_u_, hull_z_;
  EdgeWorkspace edges_;
  Column<std::uint8_t> marks_;
};

}  // namespace convexcut
