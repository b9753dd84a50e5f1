// SPDX-License-Identifier: Apache-2.0
//
// The loops over all points of a slice, in the form that compilers vectorise: arrays of float, no
// branches. Only gather() decides anything, with the reference's expression; the others are
// estimates whose error their callers allow for. RT: no allocation, no lock, no system call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/cloud.hpp"
#include "core/convex_cut/shell_index.hpp"
#include "core/convex_cut/slicing_plane.hpp"

namespace convexcut {

// The kernels work on blocks of this many points and may read and write the rest of the last block:
// the columns of a slice have room for it.
inline constexpr std::size_t kKernelBlock = 32;

// Points of one slice; the columns have the same capacity.
struct SliceColumns {
  float* u;                 // metres, along the plane
  float* z;                 // metres, up
  std::uint32_t* position;  // in the sorted points
};

// Appends the points of `range` with |v| < half_width_m; returns the new number of members.
[[nodiscard]] std::size_t gather(const CloudView& sorted, ShellIndex::Range range,
                                 const SlicingPlane& plane, double half_width_m,
                                 const SliceColumns& members, std::size_t count) noexcept;

// Indices of members that are (nearly, to 2⁻¹² of their value) outermost in sixteen directions.
// Some may be equal. Needs 0 < count.
inline constexpr std::size_t kExtremes = 16;
[[nodiscard]] std::array<std::size_t, kExtremes> extremes(const SliceColumns& members,
                                                          std::size_t count) noexcept;

// Lines n·p = offset with unit normals n, each bounding the half-plane n·p ≥ offset.
struct EdgeColumns {
  float* normal_u;
  float* normal_z;
  float* offset;  // metres
};

// depth[i] = how far point i lies within all half-planes: its distance from the nearest line,
// negative outside. For the edges of a convex polygon and a point inside, that is the distance from
// the polygon's boundary. Metres; needs at least one edge.
void depth_within(const EdgeColumns& edges, std::size_t edge_count, const SliceColumns& points,
                  std::size_t count, float* depth) noexcept;

}  // namespace convexcut
