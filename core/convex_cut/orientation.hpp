// SPDX-License-Identifier: Apache-2.0
//
// Which way three points turn, without rounding. A hull that is built with rounded cross products
// depends on the order of its points and on the algorithm; with the exact sign the set of its
// vertices is a property of the points alone, which any correct algorithm finds.
#pragma once

#include <cmath>
#include <limits>

#include "core/convex_cut/slice_point.hpp"

namespace convexcut {

namespace detail {
// The same without the filter, for the few cases that rounding leaves open.
[[nodiscard]] int exact_orientation(const SlicePoint& a, const SlicePoint& b,
                                    const SlicePoint& c) noexcept;
}  // namespace detail

// Shewchuk's ccwerrboundA with ε = 2⁻⁵³: the rounded determinant has the right sign when it is at
// least this part of the sum of its two products' magnitudes.
inline constexpr double kHalfUlp = std::numeric_limits<double>::epsilon() / 2;
inline constexpr double kOrientationFilter = (3.0 + 16.0 * kHalfUlp) * kHalfUlp;

// +1: a → b → c turns left (counter-clockwise), −1: right, 0: exactly collinear. Exact for finite
// coordinates whose products of two neither overflow nor underflow (1e-140 … 1e140 is safe). After
// J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates", 1997: a filter on the rounded determinant, then an expansion of all its products.
[[nodiscard]] inline int orientation(const SlicePoint& a, const SlicePoint& b,
                                     const SlicePoint& c) noexcept {
  const double left = (a.u - c.u) * (b.z - c.z);
  const double right = (a.z - c.z) * (b.u - c.u);
  const double determinant = left - right;
  if (std::abs(determinant) >= kOrientationFilter * (std::abs(left) + std::abs(right))) {
    return static_cast<int>(determinant > 0.0) - static_cast<int>(determinant < 0.0);
  }
  return detail::exact_orientation(a, b, c);
}

}  // namespace convexcut
