// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "core/convex_cut/slice_point.hpp"

namespace convexcut {

// The vertices of the convex hull of `points`, counter-clockwise from the least (u, z), without
// those in the middle of an edge: exact (see orientation.hpp). Fewer than three vertices when the
// points are all equal or collinear; of equal points one is taken. Sorts `points` in place;
// `vertices` has room for one more than there are points. RT: no allocation, no lock, no system
// call.
//
// A. M. Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions", 1979.
[[nodiscard]] std::span<const SlicePoint> convex_hull(std::span<SlicePoint> points,
                                                      std::span<SlicePoint> vertices) noexcept;

}  // namespace convexcut
