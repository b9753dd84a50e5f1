// SPDX-License-Identifier: Apache-2.0
//
// The members of a slice against the edges of a polygon, compiled for every instruction set as
// those in slice_kernels.hpp. RT: no allocation, no lock, no system call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_cut/slice_kernels.hpp"

namespace convexcut {

// Corners of a closed polygon, counter-clockwise, in metres. In front of the first comes the last
// one again, behind the last the first one, and kKernelPadding elements more can be read.
struct Polygon {
  const double* u = nullptr;
  const double* z = nullptr;
  std::size_t size = 0;
};

// Lines n·p = offset with unit normals n, each bounding the half-plane n·p ≥ offset. A point's
// depth is its distance from the nearest line, negative outside of any half-plane. For the edges of
// a convex polygon and a point inside, that is the distance from the polygon's boundary.
struct EdgeColumns {
  float* normal_u;
  float* normal_z;
  float* offset;  // metres
  std::size_t count = 0;
};

// Edges with the part of the u axis that each is over. Those at the least and the greatest u reach
// to infinity: every u has an edge above and one below.
struct PolygonEdges : EdgeColumns {
  float* least_u;
  float* most_u;
};

// The edges of a polygon into `edges`, whose columns have kKernelPadding elements to spare: edge k
// leads from corner k − 1 to corner k. Rounded once from double.
void set_edges(const Polygon& polygon, PolygonEdges& edges) noexcept;

struct Turns {
  bool all_left = false;   // every corner, exactly; false also where rounding leaves doubt
  std::size_t rounds = 0;  // how often the edges turn from leading left to leading right
};
[[nodiscard]] Turns find_turns(const Polygon& polygon) noexcept;

// The kernels below take members stretch by stretch, and compare those of a stretch only with the
// edges that are over it or at most `limit_m` beside it. A convex polygon has its boundary above
// and below a point inside it there, and nothing of it elsewhere is within limit_m of the point: a
// depth that exceeds the limit does so for all edges. `facing`: room for as many edges.

// Copies the members that are at most limit_m deep to `shallow`, without kMarked, in the same
// order, and returns how many these are.
[[nodiscard]] std::size_t find_shallow(const PolygonEdges& edges, const EdgeColumns& facing,
                                       const SliceColumns& members,
                                       std::span<const Stretch> stretches, float limit_m,
                                       const SliceColumns& shallow) noexcept;

// Sets marks[position] for the members that are not marked and less than surely_m deep, writes the
// positions of the others that are at most limit_m deep to `doubtful`, and returns how many these
// are. `near`: room for as many positions as there are members.
[[nodiscard]] std::size_t mark_near(const PolygonEdges& edges, const EdgeColumns& facing,
                                    const SliceColumns& members, std::span<const Stretch> stretches,
                                    float surely_m, float limit_m, std::span<std::uint8_t> marks,
                                    std::uint32_t* near, std::uint32_t* doubtful) noexcept;

// The kernels below take all edges and all members.

// Drops the members that are deeper than limit_m; how many are left, in the same order.
[[nodiscard]] std::size_t drop_deep(const EdgeColumns& edges, const SliceColumns& members,
                                    std::size_t count, float limit_m) noexcept;

// For each edge the member that is (nearly, to a part of bit_ceil(count)·2⁻²⁴) farthest outside of
// it, or kNobody when none is by more than tolerance_m. `found` has kKernelPadding elements to
// spare.
inline constexpr std::uint32_t kNobody = 0xFFFF'FFFF;
void farthest_outside(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float tolerance_m, std::uint32_t* found) noexcept;

}  // namespace convexcut
