// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/inner_polygon.hpp"

#include "core/convex_cut/orientation.hpp"

namespace convexcut {
namespace {

// Rounded: good enough to choose corners.
[[nodiscard]] bool turns_left(const SlicePoint& a, const SlicePoint& b,
                              const SlicePoint& c) noexcept {
  return (b.u - a.u) * (c.z - a.z) - (b.z - a.z) * (c.u - a.u) > 0.0;
}

// Of the two directions of an edge: up, or level and to the right.
[[nodiscard]] bool leads_up(const SlicePoint& from, const SlicePoint& to) noexcept {
  return to.z > from.z || (to.z == from.z && to.u > from.u);
}

}  // namespace

void InnerPolygon::close() noexcept {
  std::size_t left = 0;
  for (std::size_t k = 0; k < size_; ++k) {  // without branches: repetitions come at random
    const SlicePoint point = corner(k);
    const SlicePoint before = corner(left == 0 ? size_ - 1 : left - 1);
    u_[kFirst + left] = point.u;
    z_[kFirst + left] = point.z;
    left += static_cast<std::size_t>(point.u != before.u) |
            static_cast<std::size_t>(point.z != before.z);
  }
  size_ = left;
  bool convex = true;
  for (std::size_t k = 0; k < size_; ++k) {
    convex &= turns_left(corner(k == 0 ? size_ - 1 : k - 1), corner(k),
                         corner(k + 1 == size_ ? 0 : k + 1));
  }
  if (!convex) remove_dents();
  u_[0] = u_[size_];
  z_[0] = z_[size_];
}

void InnerPolygon::remove_dents() noexcept {
  std::size_t left = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    const SlicePoint point = corner(k);
    while (left >= 2 && !turns_left(corner(left - 2), corner(left - 1), point)) --left;
    if (left > 0 && point == corner(left - 1)) continue;
    u_[kFirst + left] = point.u;
    z_[kFirst + left] = point.z;
    ++left;
  }
  while (left > 2 && !turns_left(corner(left - 2), corner(left - 1), corner(0))) --left;
  size_ = left;
}

bool InnerPolygon::goes_around_once() const noexcept {
  std::size_t turns = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    const std::size_t at = kFirst + k;
    const std::size_t next = k + 1 == size_ ? kFirst : at + 1;
    turns += static_cast<std::size_t>(u_[at - 1] >= u_[at]) &
             static_cast<std::size_t>(u_[at] < u_[next]);
  }
  return turns == 1;
}

bool InnerPolygon::is_convex() const noexcept {
  std::size_t turns = 0;
  SlicePoint before = corner(size_ - 2);
  SlicePoint at = corner(size_ - 1);
  for (std::size_t k = 0; k < size_; ++k) {
    const SlicePoint next = corner(k);
    if (orientation(before, at, next) <= 0) return false;
    turns += static_cast<std::size_t>(!leads_up(before, at) && leads_up(at, next));
    before = at;
    at = next;
  }
  return turns == 1;
}

}  // namespace convexcut
