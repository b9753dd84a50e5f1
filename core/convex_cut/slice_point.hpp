// SPDX-License-Identifier: Apache-2.0
//
// A point of a slice, in the slice's own plane, and its distance from a hull edge.
#pragma once

#include <algorithm>

namespace convexcut {

// Metres. u runs along the plane's horizontal direction, z is up; ordered by u, then z. Without
// defaults, so that a Workspace of them stays untouched until it is used.
struct SlicePoint {
  double u;
  double z;
  friend constexpr bool operator==(const SlicePoint&, const SlicePoint&) = default;
  friend constexpr bool operator<(const SlicePoint& a, const SlicePoint& b) noexcept {
    return a.u < b.u || (a.u == b.u && a.z < b.z);
  }
};

// Square of the distance from p to the segment a–b (a ≠ b), in m².
[[nodiscard]] inline double squared_distance(const SlicePoint& p, const SlicePoint& a,
                                             const SlicePoint& b) noexcept {
  const double edge_u = b.u - a.u;
  const double edge_z = b.z - a.z;
  const double along = (p.u - a.u) * edge_u + (p.z - a.z) * edge_z;
  const double t = std::clamp(along / (edge_u * edge_u + edge_z * edge_z), 0.0, 1.0);
  const double du = p.u - (a.u + t * edge_u);
  const double dz = p.z - (a.z + t * edge_z);
  return du * du + dz * dz;
}

}  // namespace convexcut
