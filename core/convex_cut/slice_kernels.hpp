// SPDX-License-Identifier: Apache-2.0
//
// The loops over all points of a slice, written once and compiled for every instruction set
// (Highway, chosen when first called). They work on estimates in float whose error is bounded, and
// leave to their callers, or to the reference's own expression, what the estimates cannot decide:
// no instruction set labels a point differently. RT: no allocation, no lock, no system call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/cloud.hpp"
#include "core/convex_cut/cloud_kernels.hpp"
#include "core/convex_cut/shell_index.hpp"
#include "core/convex_cut/slicing_plane.hpp"

namespace convexcut {

// In a member's position: another slice has made this point structure already.
inline constexpr std::uint32_t kMarked = 0x8000'0000;

// Points of one slice; the columns have the same capacity.
struct SliceColumns {
  float* u;                 // metres, along the plane
  float* z;                 // metres, up
  std::uint32_t* position;  // in the sorted points, with kMarked
};

// Members [begin, end) of a slice that lie together: their u are within the bounds, in metres.
struct Stretch {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  float least_u_m = 0.0F;
  float most_u_m = 0.0F;
};

// Writes the candidates with |v| < half_width_m, in their order, a stretch for each range of them,
// and returns how many these are. `marks`: a byte a sorted point, 1 where it is structure already.
// extent_m: the greatest magnitude of a coordinate. u has an error below 4.3·2⁻²⁴·extent.
[[nodiscard]] std::size_t gather(const CloudView& sorted, std::span<const std::uint8_t> marks,
                                 std::span<const ShellIndex::Candidates> candidates,
                                 const SlicingPlane& plane, double half_width_m, float extent_m,
                                 const SliceColumns& members, Stretch* stretches) noexcept;

// Indices of members that are (nearly, to 2⁻¹² of their value) outermost in sixteen directions,
// counter-clockwise from +u. Some may be equal. Needs 0 < count < 2³¹.
inline constexpr std::size_t kExtremes = 16;
using Extremes = std::array<std::uint32_t, kExtremes>;
[[nodiscard]] Extremes extremes(const SliceColumns& members, std::size_t count) noexcept;

}  // namespace convexcut
