// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/shell_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/convex_cut/cloud_kernels.hpp"
#include "core/convex_cut/direction.hpp"

namespace convexcut {
namespace {

constexpr std::size_t kKeys = ShellIndex::kShells * ShellIndex::kBuckets;
static_assert(kKeys <= 0x1'0000, "a key is 16 bits wide");

// Windows are this much wider than exact arithmetic asks for, in units of the turn below and
// relative to the radius: a hundred times the rounding of the float keys.
constexpr double kTurnSlack = 1e-4;
constexpr double kRadiusSlack = 1e-5;

}  // namespace

ShellIndex::ShellIndex(double half_width_m, std::size_t max_points)
    : inverse_squared_half_width_(static_cast<float>(1.0 / (half_width_m * half_width_m))),
      x_(max_points + kKernelPadding),
      y_(max_points + kKernelPadding),
      z_(max_points + kKernelPadding),
      source_(max_points),
      keys_(max_points + kKernelPadding),
      first_half_starts_(kKeys),
      starts_(kKeys + 1) {
  for (std::size_t shell = 0; shell < kShells; ++shell) {
    // |u|² = r² − v², and |v| < d.
    const double squared_d = half_width_m * half_width_m;
    const double inner = std::ldexp(squared_d, static_cast<int>(shell)) * (1.0 - kRadiusSlack);
    const double outer = std::ldexp(squared_d, static_cast<int>(shell) + 1) * (1.0 + kRadiusSlack);
    least_u_m_[shell] =
        static_cast<float>(std::sqrt(std::max(inner - squared_d, 0.0)) * (1.0 - kRadiusSlack));
    most_u_m_[shell] = static_cast<float>(std::sqrt(outer) * (1.0 + kRadiusSlack));
  }
  most_u_m_.back() = std::numeric_limits<float>::max();
}

// A counting sort of two halves at once: points that follow each other often have the same key, and
// would wait for each other's count.
void ShellIndex::build(const CloudView& cloud) noexcept {
  size_ = cloud.size();
  shell_keys(cloud, 0, size_, inverse_squared_half_width_, keys_.data());
  std::ranges::fill(first_half_starts_, 0U);
  std::ranges::fill(starts_, 0U);
  std::uint32_t* const first = first_half_starts_.data();
  // Of the second half, one place further on: where a key's points end, the next one's begin.
  std::uint32_t* const second = starts_.data() + 1;
  const std::size_t half = size_ / 2;
  const std::uint16_t* const keys = keys_.data();
  for (std::size_t i = 0; i < half; ++i) {
    ++first[keys[i]];
    ++second[keys[half + i]];
  }
  if (2 * half < size_) ++second[keys[size_ - 1]];

  std::uint32_t begin = 0;
  for (std::size_t k = 0; k < kKeys; ++k) {
    const std::uint32_t in_first = first[k];
    const std::uint32_t in_second = second[k];
    first[k] = begin;
    second[k] = begin + in_first;
    begin += in_first + in_second;
  }

  const auto place = [&](std::size_t i, std::uint32_t position) noexcept {
    x_[position] = cloud.x[i];
    y_[position] = cloud.y[i];
    z_[position] = cloud.z[i];
    source_[position] = static_cast<std::uint32_t>(i);
  };
  for (std::size_t i = 0; i < half; ++i) {
    place(i, first[keys[i]]++);
    place(half + i, second[keys[half + i]]++);
  }
  if (2 * half < size_) place(size_ - 1, second[keys[size_ - 1]]++);
  find_used_shells();
}

void ShellIndex::find_used_shells() noexcept {
  used_shell_count_ = 0;
  for (std::size_t shell = 0; shell < kShells; ++shell) {
    const bool used = starts_[shell * kBuckets] != starts_[(shell + 1) * kBuckets];
    if (used) used_shells_[used_shell_count_++] = shell;
  }
}

ShellIndex::Windows ShellIndex::windows(const SlicingPlane& plane) noexcept {
  constexpr double kBucketsPerUnit = static_cast<double>(kBuckets) / kTurn<double>;
  constexpr auto kAllBuckets = static_cast<std::int64_t>(kBuckets);
  Windows windows;
  for (std::size_t shell = 1; shell < kShells; ++shell) {
    const double sine = std::exp2(-0.5 * static_cast<double>(shell)) * (1.0 + kRadiusSlack);
    const double cosine = std::sqrt(1.0 - sine * sine);
    // The plane's direction turned by ∓asin(d/r).
    const double from = direction(plane.cos_theta * cosine + plane.sin_theta * sine,
                                  plane.sin_theta * cosine - plane.cos_theta * sine);
    double to = direction(plane.cos_theta * cosine - plane.sin_theta * sine,
                          plane.sin_theta * cosine + plane.cos_theta * sine);
    if (to < from) to += kTurn<double>;
    const auto first = static_cast<std::int64_t>(std::floor((from - kTurnSlack) * kBucketsPerUnit));
    const auto last = static_cast<std::int64_t>(std::floor((to + kTurnSlack) * kBucketsPerUnit));
    windows[shell] = {static_cast<std::uint16_t>((first + kAllBuckets) % kAllBuckets),
                      static_cast<std::uint16_t>(std::min(last - first + 1, kAllBuckets))};
  }
  return windows;
}

}  // namespace convexcut
