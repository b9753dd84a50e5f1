// SPDX-License-Identifier: Apache-2.0
//
// One slicing plane and the arithmetic that decides. The reference and the fast engine both decide
// with these expressions in exactly this form: that is why their labels are equal bit by bit.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/convex_cut/slice_point.hpp"

namespace convexcut {

// The plane that contains the z axis and the direction (cos θ, sin θ, 0). Metres, frame level.
struct SlicingPlane {
  double cos_theta = 1.0;
  double sin_theta = 0.0;

  // v: signed distance of a point from the plane.
  [[nodiscard]] double offset(float x, float y) const noexcept {
    return -static_cast<double>(x) * sin_theta + static_cast<double>(y) * cos_theta;
  }
  // u: coordinate along the plane's horizontal direction.
  [[nodiscard]] double along(float x, float y) const noexcept {
    return static_cast<double>(x) * cos_theta + static_cast<double>(y) * sin_theta;
  }
  [[nodiscard]] SlicePoint project(float x, float y, float z) const noexcept {
    return {along(x, y), static_cast<double>(z)};
  }
};

// Plane i of n: θᵢ = π·i/n.
[[nodiscard]] inline SlicingPlane slicing_plane(std::uint32_t i, std::uint32_t n) noexcept {
  const double theta = std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
  return {std::cos(theta), std::sin(theta)};
}

}  // namespace convexcut
