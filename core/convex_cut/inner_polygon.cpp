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

}  // namespace

void InnerPolygon::close() noexcept {
  find_turns();
  if (turns_.all_left) return;
  remove_dents();
  find_turns();
}

void InnerPolygon::find_turns() noexcept {
  for (auto* column : {&u_, &z_}) {
    (*column)[0] = (*column)[size_];
    (*column)[kFirst + size_] = (*column)[kFirst];
  }
  turns_ = convexcut::find_turns(polygon());
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

bool InnerPolygon::is_convex() const noexcept {
  if (!goes_around_once()) return false;
  if (turns_.all_left) return true;
  for (std::size_t k = 0; k < size_; ++k) {
    const SlicePoint& before = corner(k == 0 ? size_ - 1 : k - 1);
    const SlicePoint& next = corner(k + 1 == size_ ? 0 : k + 1);
    if (orientation(before, corner(k), next) <= 0) return false;
  }
  return true;
}

}  // namespace convexcut
