// SPDX-License-Identifier: Apache-2.0
//
// A cheap stand-in for the direction of a point.
#pragma once

#include <cmath>

namespace convexcut {

template <class Real>
inline constexpr Real kHalfTurn = 4;
template <class Real>
inline constexpr Real kTurn = 2 * kHalfTurn<Real>;

// Bends the tangent towards the angle: within an eighth of a turn the polynomial below is close to
// it. It need not be the angle, for both points and windows use it.
template <class Real>
inline constexpr Real kBend = static_cast<Real>(0.3476);
// Gives the point on the axis some direction, and no other one a different one.
template <class Real>
inline constexpr Real kNoLength = static_cast<Real>(1e-30);

// A number that grows with the direction of (x, y) from 0 (along x) over 1 (45°), 2 (along y) and 4
// (along −x) to 8, which is 0 again.
template <class Real>
[[nodiscard]] Real direction(Real x, Real y) noexcept {
  const bool below = std::signbit(y);
  const Real along = below ? -x : x;
  const Real width = std::abs(x);
  const Real height = std::abs(y);
  const Real longer = width > height ? width : height;
  const Real shorter = width > height ? height : width;
  const Real tangent = shorter / (longer + kNoLength<Real>);
  const Real eighth = tangent * (1 + kBend<Real> * (1 - tangent));
  const Real quarter = width > height ? eighth : 2 - eighth;
  const Real half = along < 0 ? kHalfTurn<Real> - quarter : quarter;
  return below ? kHalfTurn<Real> + half : half;
}

}  // namespace convexcut
