// SPDX-License-Identifier: Apache-2.0
//
// The hull of a slice that has been done, which late members make larger.
#pragma once

#include <array>
#include <cstddef>

#include "core/convex_cut/polygon_kernels.hpp"
#include "core/convex_cut/slice_point.hpp"

namespace convexcut {

// RT: no allocation, no lock, no system call.
class KeptHull {
 public:
  static constexpr std::size_t kMostCorners = 64;

  using Corners = std::array<double, kMostCorners>;

  // A strictly convex polygon of at most kMostCorners, counter-clockwise; or none.
  void set(const Polygon& hull) noexcept;
  // Becomes the hull of itself and the point, exactly: as convex_hull() of all its points would be,
  // from another corner on. False when the point is within it. Needs size() in [3, kMostCorners).
  bool add(const SlicePoint& point) noexcept;
  // After points have been added.
  void set_edges() noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] Polygon polygon() const noexcept { return {u_.data() + 1, z_.data() + 1, size_}; }
  [[nodiscard]] PolygonEdges edges() noexcept {
    return {{normal_u_.data(), normal_z_.data(), offset_.data(), size_},
            least_u_.data(),
            most_u_.data()};
  }

 private:
  [[nodiscard]] SlicePoint corner(std::size_t k) const noexcept { return {u_[k + 1], z_[k + 1]}; }

  template <class T>
  using Padded = std::array<T, kMostCorners + kKernelPadding>;

  std::size_t size_ = 0;
  Padded<double> u_{}, z_{};  // in front the last one again
  Padded<float> normal_u_{}, normal_z_{}, offset_{}, least_u_{}, most_u_{};
};

}  // namespace convexcut
