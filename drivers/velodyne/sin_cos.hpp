// SPDX-License-Identifier: Apache-2.0
//
// Sine and cosine of an azimuth, by angle addition from a table of whole degrees. Faster than the
// C library's and the same bits with every library and processor; the table (5.8 kB) stays in the
// first-level cache, which one of 36 000 directions would not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "core/angle.hpp"

namespace convexcut::velodyne {

struct SinCos {
  double sin = 0.0;
  double cos = 1.0;
};

namespace detail {

// Taylor series, for 0 … 45°: the first omitted term is below 1e-20.
constexpr SinCos sin_cos_by_series(double radians) noexcept {
  SinCos sum{0.0, 0.0};
  double term = 1.0;  // radians^n / n!
  for (int n = 0; n < 20; ++n) {
    double& part = n % 2 == 0 ? sum.cos : sum.sin;
    part += n % 4 < 2 ? term : -term;
    term *= radians / (n + 1);
  }
  return sum;
}

// Reduced to 0 … 45° first, so that the multiples of 90° come out exact.
constexpr SinCos sin_cos_of_whole_degrees(int degrees) noexcept {
  const int quadrant = degrees / 90;
  const int within = degrees % 90;
  const bool mirrored = within > 45;
  SinCos s = sin_cos_by_series((mirrored ? 90 - within : within) * (std::numbers::pi / 180.0));
  if (mirrored) s = {s.cos, s.sin};
  for (int i = 0; i < quadrant; ++i) s = {s.cos, -s.sin};
  return s;
}

inline constexpr std::array<SinCos, 361> kWholeDegrees = [] {
  std::array<SinCos, 361> table{};
  for (int degrees = 0; degrees <= 360; ++degrees) {
    table[static_cast<std::size_t>(degrees)] = sin_cos_of_whole_degrees(degrees);
  }
  return table;
}();

}  // namespace detail

// Error below 1e-12.
[[nodiscard]] constexpr SinCos sin_cos(Azimuth angle) noexcept {
  constexpr std::int32_t kDegree = 1'000'000;
  const std::int32_t nearest = (angle.microdegrees() + kDegree / 2) / kDegree;
  const SinCos base = detail::kWholeDegrees[static_cast<std::size_t>(nearest)];
  // At most half a degree is left, where the first omitted terms are 4e-13 and 6e-16.
  const double rest =
      (angle.microdegrees() - nearest * kDegree) * (std::numbers::pi / 180.0 / kDegree);
  const double rest2 = rest * rest;
  const double sin = rest - rest * rest2 * (1.0 / 6.0);
  const double cos = 1.0 - rest2 * 0.5 + rest2 * rest2 * (1.0 / 24.0);
  return {base.sin * cos + base.cos * sin, base.cos * cos - base.sin * sin};
}

}  // namespace convexcut::velodyne
