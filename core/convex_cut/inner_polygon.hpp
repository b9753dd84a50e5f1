// SPDX-License-Identifier: Apache-2.0
//
// A closed polygon of members of a slice, which is made wider until it is the slice's hull.
//
// A point that is left of all its edges is in the hull: the polygon winds about it, convex or not.
// So members inside are no vertices of the hull, and a corner that is badly chosen leaves more to
// do, but nothing wrong.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_cut/polygon_kernels.hpp"
#include "core/convex_cut/slice_point.hpp"

namespace convexcut {

class InnerPolygon {
 public:
  static constexpr std::size_t kMostCorners = 96;

  void clear() noexcept { size_ = 0; }
  // Counter-clockwise, at most kMostCorners.
  void add(const SlicePoint& corner) noexcept {
    u_[kFirst + size_] = corner.u;
    z_[kFirst + size_] = corner.z;
    ++size_;
  }
  // Without a branch: often half of the points that are tried are no corners.
  void add_if(const SlicePoint& corner, bool is_corner) noexcept {
    u_[kFirst + size_] = corner.u;
    z_[kFirst + size_] = corner.z;
    size_ += static_cast<std::size_t>(is_corner);
  }
  // Behind the last corner: leaves out corners that repeat the one before or do not turn left.
  void close() noexcept;
  // The same for corners that all turn left, exactly: rounding must not take one for a dent.
  void close_exact() noexcept { find_turns(); }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] SlicePoint corner(std::size_t k) const noexcept {
    return {u_[kFirst + k], z_[kFirst + k]};
  }
  [[nodiscard]] Polygon polygon() const noexcept {
    return {u_.data() + kFirst, z_.data() + kFirst, size_};
  }

  // Whether its edges lead to the right and back to the left just once: then left turns make it
  // convex, but for rounding.
  [[nodiscard]] bool goes_around_once() const noexcept { return turns_.rounds == 1; }

  // Exactly: every corner turns left, and they go around once. Then no corner is in the hull of the
  // others.
  [[nodiscard]] bool is_convex() const noexcept;

 private:
  static constexpr std::size_t kFirst = 1;  // before it, the last one again
  void remove_dents() noexcept;
  void find_turns() noexcept;

  std::array<double, kFirst + kMostCorners + kKernelPadding> u_{};
  std::array<double, kFirst + kMostCorners + kKernelPadding> z_{};
  std::size_t size_ = 0;
  Turns turns_;
};

}  // namespace convexcut
