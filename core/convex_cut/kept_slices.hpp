// SPDX-License-Identifier: Apache-2.0
//
// What is kept of slices that are done, for members that come late: their hulls, and the points
// that a slightly larger hull would decide differently.
//
// A member that is at most e − m deep in a hull is at most e deep in any hull that contains this
// one and nothing farther than m outside of it; one that is more than e deep in the former is so in
// the latter. So when a slice is done, members that are less than e − m deep are structure for
// good, those within e of the boundary make a list, and nobody else is looked at again. A late
// member within the hull changes nothing; one outside makes it larger, exactly, and the list is
// decided anew; one that is too far outside means that the slice has to be done again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "core/convex_cut/column.hpp"
#include "core/convex_cut/convex_hull.hpp"
#include "core/convex_cut/edge_workspace.hpp"
#include "core/convex_cut/parameters.hpp"
#include "core/convex_cut/polygon_kernels.hpp"
#include "core/convex_cut/slice_kernels.hpp"
#include "core/convex_cut/slicing_plane.hpp"

namespace convexcut {

// One thread. RT after construction: no allocation, no lock, no system call.
class KeptSlices {
 public:
  static constexpr std::uint32_t kMostPlanes = 1'024;  // of more planes, no slice is kept
  static constexpr std::size_t kMostLate = 2'048;      // points at once

  // Allocates 5 kB a plane.
  explicit KeptSlices(const ConvexCutParameters& parameters);

  // m: 0 where no slices are kept.
  [[nodiscard]] double margin_m() const noexcept { return margin_m_; }

  // A slice has been done: its hull (none, where it has fewer than three vertices) and the members
  // that the margin leaves undecided, as any numbers. False when there is no room for them: then
  // nothing is kept, and the first late member will ask for the slice to be done again.
  [[nodiscard]] bool keep(std::uint32_t number, const Polygon& hull,
                          std::span<const std::uint32_t> undecided, float tolerance_m) noexcept;
  // Before the calls below: point_of(number) in the cloud, of the numbers given to keep(), or
  // kNobody where no decision is needed any more.
  template <class PointOf>
  void renumber(std::uint32_t number, PointOf&& point_of) noexcept {
    Slice& slice = slices_[number];
    std::size_t left = 0;
    for (const std::uint32_t known : std::span(slice.undecided).first(slice.undecided_count)) {
      slice.undecided[left] = point_of(known);
      left += slice.undecided[left] != kNobody ? 1U : 0U;
    }
    slice.undecided_count = left;
  }

  // Points that may be members: their numbers in the cloud, and columns with kKernelPadding
  // elements to spare. marks: one a point; set where the slice makes it structure for good. False
  // when the slice has to be done again.
  struct Late {
    std::span<const std::uint32_t> points;
    CloudView columns;
    std::span<std::uint8_t> marks;
  };
  [[nodiscard]] bool add(std::uint32_t number, const SlicingPlane& plane, const Late& late,
                         float extent_m) noexcept;

  // When no more points come: counts, of each point of the cloud, becomes 1 for those of the
  // undecided that are structure, as far as it is 0.
  void decide(std::uint32_t number, const SlicingPlane& plane, const CloudView& cloud,
              float extent_m, std::span<std::uint8_t> counts) noexcept;

 private:
  static constexpr std::size_t kMostCorners = 64;
  static constexpr std::size_t kMostUndecided = 1'024;

  struct Slice {
    std::array<SlicePoint, kMostCorners> corners;
    std::size_t corner_count = 0;
    double slack_m = 0.0;  // by which the hull may still grow
    std::size_t undecided_count = 0;
    std::array<std::uint32_t, kMostUndecided> undecided;  // points of the cloud
  };

  void load_hull(const Slice& slice) noexcept;
  [[nodiscard]] bool grow(Slice& slice, const SlicingPlane& plane, const Late& late,
                          std::size_t candidates, float tolerance_m) noexcept;
  [[nodiscard]] double distance_outside(const SlicePoint& point) const noexcept;
  [[nodiscard]] Polygon hull() const noexcept {
    return {hull_u_.data() + 1, hull_z_.data() + 1, hull_size_};
  }
  [[nodiscard]] SliceColumns members() noexcept { return {u_.data(), z_.data(), position_.data()}; }
  [[nodiscard]] SliceColumns shallow() noexcept {
    return {shallow_u_.data(), shallow_z_.data(), shallow_position_.data()};
  }

  double half_width_m_;
  double hull_distance_m_;
  double margin_m_;
  std::vector<Slice> slices_;

  // Of the slice at hand. In front of the hull's first corner the last one again, as Polygon asks.
  Column<double> hull_u_, hull_z_;
  std::size_t hull_size_ = 0;
  EdgeWorkspace edges_;
  Column<float> u_, z_;
  Column<std::uint32_t> position_;
  Column<float> shallow_u_, shallow_z_;
  Column<std::uint32_t> shallow_position_;
  Column<std::uint32_t> near_;
  Column<std::uint8_t> marks_;
  std::vector<std::uint32_t> undecided_;
  std::vector<HullPoint> candidates_, vertices_;
};

}  // namespace convexcut
