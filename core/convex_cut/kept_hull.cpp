// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/kept_hull.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/convex_cut/orientation.hpp"

namespace convexcut {

void KeptHull::set(const Polygon& hull) noexcept {
  size_ = hull.size;
  std::copy_n(hull.u, size_, u_.begin() + 1);
  std::copy_n(hull.z, size_, z_.begin() + 1);
  set_edges();
}

void KeptHull::set_edges() noexcept {
  u_[0] = u_[size_];
  z_[0] = z_[size_];
  PolygonEdges all = edges();
  convexcut::set_edges(polygon(), all);
}

// The edges that have the point on their outer side follow each other, and with them those whose
// lines it is on: it takes the place of the corners between them.
bool KeptHull::add(const SlicePoint& point) noexcept {
  static_assert(kMostCorners <= 64, "a bit an edge");
  std::uint64_t visible = 0;
  bool is_outside = false;
  SlicePoint from = corner(size_ - 1);
  for (std::size_t k = 0; k < size_; ++k) {
    const SlicePoint to = corner(k);
    const int turn = orientation(from, to, point);
    is_outside = is_outside || turn < 0;
    visible |= (turn <= 0 ? std::uint64_t{1} : 0U) << k;
    from = to;
  }
  if (!is_outside) return false;
  const std::uint64_t before = visible << 1U | visible >> (size_ - 1);  // is the edge before, too?
  const auto first = static_cast<std::size_t>(std::countr_zero(visible & ~before));
  const auto count = static_cast<std::size_t>(std::popcount(visible));
  std::array<SlicePoint, kMostCorners> left;
  left[0] = point;
  std::size_t left_count = 1;
  for (std::size_t k = first + count - 1; k < first + size_; ++k) {
    left[left_count++] = corner(k < size_ ? k : k - size_);
  }
  size_ = left_count;
  for (std::size_t k = 0; k < size_; ++k) {
    u_[k + 1] = left[k].u;
    z_[k + 1] = left[k].z;
  }
  return true;
}

}  // namespace convexcut
