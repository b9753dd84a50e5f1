// SPDX-License-Identifier: Apache-2.0
//
// Sine and cosine of any angle with additions and multiplications only: the C library's differ in
// the last bit between processors and versions, and a simulation is the same bytes everywhere.
#pragma once

#include <cmath>
#include <numbers>

#include "core/angle.hpp"
#include "drivers/velodyne/sin_cos.hpp"

namespace convexcut::simulation {

using velodyne::SinCos;

// Error below 1e-15 for angles of up to 10⁵ turns. Reduction to ±45° by the quarter turn in two
// parts, of which the first has 33 bits, so that its multiples are exact; then Taylor series, whose
// first omitted terms are below 1e-18.
[[nodiscard]] inline SinCos sin_cos(Radians angle) noexcept {
  constexpr double kQuarterHigh = 0x1.921fb544p+0;
  constexpr double kQuarterLow = 0x1.0b4611a626331p-34;
  const double quarters = std::floor(angle.value * (2.0 / std::numbers::pi) + 0.5);
  const double r = (angle.value - quarters * kQuarterHigh) - quarters * kQuarterLow;
  const double r2 = r * r;
  double sin = 1.0 / 355'687'428'096'000.0;  // 1/17!
  for (const double inverse :
       {1.0 / 1'307'674'368'000.0, -1.0 / 6'227'020'800.0, 1.0 / 39'916'800.0, -1.0 / 362'880.0,
        1.0 / 5'040.0, -1.0 / 120.0, 1.0 / 6.0, -1.0}) {
    sin = sin * r2 - inverse;
  }
  sin *= r;
  double cos = 1.0 / 20'922'789'888'000.0;  // 1/16!
  for (const double inverse : {1.0 / 87'178'291'200.0, -1.0 / 479'001'600.0, 1.0 / 3'628'800.0,
                               -1.0 / 40'320.0, 1.0 / 720.0, -1.0 / 24.0, 1.0 / 2.0, -1.0}) {
    cos = cos * r2 - inverse;
  }
  const auto quadrant = static_cast<unsigned>(static_cast<long long>(quarters)) & 3U;
  if ((quadrant & 1U) != 0) {
    const double old_sin = sin;
    sin = cos;
    cos = -old_sin;
  }
  return (quadrant & 2U) != 0 ? SinCos{-sin, -cos} : SinCos{sin, cos};
}

}  // namespace convexcut::simulation
