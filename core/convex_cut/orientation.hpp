// SPDX-License-Identifier: Apache-2.0
//
// Which way three points turn, without rounding. A hull that is built with rounded cross products
// depends on the order of its points and on the algorithm; with the exact sign the set of its
// vertices is a property of the points alone, which any correct algorithm finds.
#pragma once

#include "core/convex_cut/slice_point.hpp"

namespace convexcut {

// +1: a → b → c turns left (counter-clockwise), −1: right, 0: exactly collinear. Exact for finite
// coordinates whose products of two neither overflow nor underflow (1e-140 … 1e140 is safe). After
// J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates", 1997: a filter on the rounded determinant, then an expansion of all its products.
[[nodiscard]] int orientation(const SlicePoint& a, const SlicePoint& b,
                              const SlicePoint& c) noexcept;

}  // namespace convexcut
