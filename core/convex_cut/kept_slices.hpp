// SPDX-License-Identifier: Apache-2.0
//
// The hulls of slices that are done, kept for members that come late.
//
// A member that is at most e − m deep in a hull is at most e deep in any hull that contains this
// one and nothing farther than m outside of it; one that is more than e deep in the former is so in
// the latter. So when a slice is done, members that are less than e − m deep are structure for
// good, those within e of the boundary are undecided, and nobody else is looked at again. A late
// member within the hull changes nothing; one outside makes it larger, exactly, and what is
// undecided is decided by the last hull; one that is farther than m outside of the first hull means
// that the slice has to be done again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "core/convex_cut/column.hpp"
#include "core/convex_cut/kept_hull.hpp"
#include "core/convex_cut/parameters.hpp"
#include "core/convex_cut/shell_index.hpp"
#include "core/convex_cut/slice_kernels.hpp"
#include "core/convex_cut/slicing_plane.hpp"

namespace convexcut {

// One thread. RT after construction: no allocation, no lock, no system call.
class KeptSlices {
 public:
  static constexpr std::uint32_t kMostPlanes = 1'024;    // of more planes, no slice is kept
  static constexpr std::size_t kMostCandidates = 8'192;  // points at once

  // Allocates 6 kB a plane.
  explicit KeptSlices(const ConvexCutParameters& parameters);

  // m: 0 where no slices are kept.
  [[nodiscard]] double margin_m() const noexcept { return margin_m_; }

  // A slice has been done: its hull (none, where it has fewer than three vertices). False when
  // there is no room for it: then nothing is kept, and the first late member will ask for the slice
  // to be done again.
  [[nodiscard]] bool keep(std::uint32_t number, const Polygon& hull, float tolerance_m) noexcept;

  // Points that may be members, in columns with kKernelPadding elements to spare, with bounds of u,
  // and a mark for each: set where it is structure.
  struct Candidates {
    CloudView points;
    std::span<const ShellIndex::Candidates> ranges;
    std::span<std::uint8_t> marks;
  };
  static constexpr std::size_t kMostRanges = 2;

  // Of candidates that come late: marks what the slice makes structure for good, and sets
  // is_undecided of what it leaves undecided. False when the slice has to be done again.
  [[nodiscard]] bool add(std::uint32_t number, const SlicingPlane& plane, const Candidates& late,
                         std::span<std::uint8_t> is_undecided, float extent_m) noexcept;

  // When no more points come: marks those of the undecided that the slice makes structure.
  void decide(std::uint32_t number, const SlicingPlane& plane, const Candidates& undecided,
              float extent_m) noexcept;

 private:
  struct Slice {
    KeptHull hull;
    KeptHull::Corners first_u, first_z;  // the hull when the slice was done
    std::size_t first_size = 0;
    double slack_m = 0.0;  // what is added may be so far outside of it

    [[nodiscard]] Polygon first() const noexcept {
      return {first_u.data(), first_z.data(), first_size};
    }
  };

  [[nodiscard]] bool grow(Slice& slice, const SlicingPlane& plane, const CloudView& late,
                          std::size_t outside) noexcept;
  [[nodiscard]] SliceColumns members() noexcept { return {u_.data(), z_.data(), position_.data()}; }
  [[nodiscard]] SliceColumns shallow() noexcept {
    return {shallow_u_.data(), shallow_z_.data(), shallow_position_.data()};
  }

  double half_width_m_;
  double hull_distance_m_;
  double margin_m_;
  std::vector<Slice> slices_;

  // Of the slice at hand.
  Column<float> facing_normal_u_, facing_normal_z_, facing_offset_;
  EdgeColumns facing_;
  Column<float> u_, z_;
  Column<std::uint32_t> position_;
  Column<float> shallow_u_, shallow_z_;
  Column<std::uint32_t> shallow_position_;
  Column<std::uint32_t> near_;
};

}  // namespace convexcut
