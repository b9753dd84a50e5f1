// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/shell_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace convexcut {
namespace {

constexpr std::size_t kKeys = ShellIndex::kShells * ShellIndex::kBuckets;
static_assert(kKeys <= 0x1'0000, "a key is 16 bits wide");

// Windows are this much wider than exact arithmetic asks for, in units of the turn below and
// relative to the radius: a hundred times the rounding of the float keys.
constexpr double kTurnSlack = 1e-4;
constexpr double kRadiusSlack = 1e-5;

// A number that grows with the direction of (x, y) modulo 180°, from 0 (along x) over 1 (45°) and
// 2 (along y) to 4 (180°, which is 0 again). Within an eighth of a turn it is a polynomial in the
// tangent, close to the angle; it need not be the angle, for both points and windows use it.
template <class Real>
[[nodiscard]] Real turn_modulo_half(Real x, Real y) noexcept {
  constexpr Real kBend = static_cast<Real>(0.3476);
  const Real along = y < 0 ? -x : x;
  const Real width = std::abs(x);
  const Real height = std::abs(y);
  const Real longer = width > height ? width : height;
  const Real shorter = width > height ? height : width;
  // The tiny term gives the point on the axis some direction, and no other one a different one.
  const Real tangent = shorter / (longer + static_cast<Real>(1e-30));
  const Real eighth = tangent * (1 + kBend * (1 - tangent));
  const Real quarter = width > height ? eighth : 2 - eighth;
  return along < 0 ? 4 - quarter : quarter;
}

constexpr float kBucketsPerTurnUnit = static_cast<float>(ShellIndex::kBuckets) / 4.0F;

[[nodiscard]] std::uint16_t key_of(float x, float y, float inverse_squared_half_width) noexcept {
  constexpr std::int32_t kExponentShift = 23;
  constexpr std::int32_t kExponentBias = 127;
  constexpr std::int32_t kLastShell = ShellIndex::kShells - 1;
  constexpr std::int32_t kLastBucket = ShellIndex::kBuckets - 1;
  // (r/d)² in [2ˢ, 2ˢ⁺¹) has the exponent s.
  const float ratio = (x * x + y * y) * inverse_squared_half_width;
  const std::int32_t exponent =
      (std::bit_cast<std::int32_t>(ratio) >> kExponentShift) - kExponentBias;
  const std::int32_t shell = std::clamp(exponent, 0, kLastShell);
  const std::int32_t bucket = std::min(
      static_cast<std::int32_t>(turn_modulo_half(x, y) * kBucketsPerTurnUnit), kLastBucket);
  return static_cast<std::uint16_t>(shell * static_cast<std::int32_t>(ShellIndex::kBuckets) +
                                    bucket);
}

}  // namespace

ShellIndex::ShellIndex(double half_width_m, std::size_t max_points)
    : inverse_squared_half_width_(static_cast<float>(1.0 / (half_width_m * half_width_m))),
      x_(max_points),
      y_(max_points),
      z_(max_points),
      source_(max_points),
      keys_(max_points),
      starts_(kKeys + 1) {}

void ShellIndex::build(const CloudView& cloud) noexcept {
  size_ = cloud.size();
  for (std::size_t i = 0; i < size_; ++i) {
    keys_[i] = key_of(cloud.x[i], cloud.y[i], inverse_squared_half_width_);
  }
  // Counting sort. starts_[k + 1] first counts key k, then is where it begins, and once all its
  // points are placed, where key k + 1 begins: no second table is needed.
  std::ranges::fill(starts_, 0U);
  for (std::size_t i = 0; i < size_; ++i) ++starts_[keys_[i] + 1U];
  std::uint32_t begin = 0;
  for (std::size_t k = 1; k <= kKeys; ++k) {
    const std::uint32_t count = starts_[k];
    starts_[k] = begin;
    begin += count;
  }
  for (std::size_t i = 0; i < size_; ++i) {
    const std::size_t position = starts_[keys_[i] + 1U]++;
    x_[position] = cloud.x[i];
    y_[position] = cloud.y[i];
    z_[position] = cloud.z[i];
    source_[position] = static_cast<std::uint32_t>(i);
  }
}

ShellIndex::Windows ShellIndex::windows(const SlicingPlane& plane) noexcept {
  constexpr double kBucketsPerUnit = static_cast<double>(kBuckets) / 4.0;
  constexpr auto kAllBuckets = static_cast<std::int64_t>(kBuckets);
  Windows windows;
  windows[0] = {0, static_cast<std::uint16_t>(kBuckets)};
  for (std::size_t shell = 1; shell < kShells; ++shell) {
    const double sine = std::exp2(-0.5 * static_cast<double>(shell)) * (1.0 + kRadiusSlack);
    const double cosine = std::sqrt(1.0 - sine * sine);
    // The plane's direction turned by ∓asin(d/r).
    const double from = turn_modulo_half(plane.cos_theta * cosine + plane.sin_theta * sine,
                                         plane.sin_theta * cosine - plane.cos_theta * sine);
    double to = turn_modulo_half(plane.cos_theta * cosine - plane.sin_theta * sine,
                                 plane.sin_theta * cosine + plane.cos_theta * sine);
    if (to < from) to += 4.0;
    const auto first = static_cast<std::int64_t>(std::floor((from - kTurnSlack) * kBucketsPerUnit));
    const auto last = static_cast<std::int64_t>(std::floor((to + kTurnSlack) * kBucketsPerUnit));
    windows[shell] = {static_cast<std::uint16_t>((first + kAllBuckets) % kAllBuckets),
                      static_cast<std::uint16_t>(std::min(last - first + 1, kAllBuckets))};
  }
  return windows;
}

}  // namespace convexcut
