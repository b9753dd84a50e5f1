// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/convex_cut/polygon_kernels.hpp"
#include "core/convex_cut/slice_point.hpp"

namespace convexcut {

// The reference's decision: any edge of the hull within the distance.
[[nodiscard]] inline bool near_boundary(const SlicePoint& point, const Polygon& hull,
                                        double distance_m) noexcept {
  SlicePoint from{hull.u[hull.size - 1], hull.z[hull.size - 1]};
  for (std::size_t k = 0; k < hull.size; ++k) {
    const SlicePoint to{hull.u[k], hull.z[k]};
    if (squared_distance(point, from, to) <= distance_m * distance_m) return true;
    from = to;
  }
  return false;
}

}  // namespace convexcut
