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

// Corners of a closed polygon, counter-clockwise, in metres. corner[-1] is the last one again, and
// kKernelPadding elements behind the last can be read.
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

// The edges of a polygon into `edges`, whose columns have kKernelPadding elements to spare: edge k
// leads from corner k − 1 to corner k. Rounded once from double.
void set_edges(const Polygon& polygon, EdgeColumns& edges) noexcept;

struct Sifted {
  std::size_t shallow = 0;  // members at most `shallow_m` deep
  std::size_t open = 0;     // members at most `open_m` deep that are not marked
};
// Copies the shallow members to `shallow`, without kMarked, and drops all but the open ones from
// `members`, each in the same order.
[[nodiscard]] Sifted sift(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                          float shallow_m, float open_m, const SliceColumns& shallow) noexcept;

// Drops the members that are deeper than limit_m; how many are left, in the same order.
[[nodiscard]] std::size_t drop_deep(const EdgeColumns& edges, const SliceColumns& members,
                                    std::size_t count, float limit_m) noexcept;

// For each edge the member that is (nearly, to a part of bit_ceil(count)·2⁻²⁴) farthest outside of
// it, or kNobody when none is by more than tolerance_m. `found` has kKernelPadding elements to
// spare.
inline constexpr std::uint32_t kNobody = 0xFFFF'FFFF;
void farthest_outside(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float tolerance_m, std::uint32_t* found) noexcept;

// Sets marks[position] for the members that are less than e − tolerance deep, drops all but those
// within the tolerance of e, takes kMarked from their positions, and returns how many these are.
[[nodiscard]] std::size_t mark_near(const EdgeColumns& edges, const SliceColumns& members,
                                    std::size_t count, float e_m, float tolerance_m,
                                    std::span<std::uint8_t> marks) noexcept;

}  // namespace convexcut
