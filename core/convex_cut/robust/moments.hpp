// SPDX-License-Identifier: Apache-2.0
//
// Sums over the points of a voxel: their number, mean and covariance. Whole numbers (millimetres
// from the voxel's centre), so that what was added can be taken away again without a trace.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Eigenvalues>

#include "core/geometry.hpp"

namespace convexcut::robust {

using Mat3f = Eigen::Matrix3f;

// A coordinate of kilometres is rounded by more than a voxel: its offset is cut off at this.
inline constexpr float kMostOffsetM = 0.2F;

struct Moments {
  std::array<std::int32_t, 3> sum_mm{};
  std::int32_t count = 0;
  std::array<std::int32_t, 6> products_mm2{};  // xx xy xz yy yz zz

  // One point, by its offset from the centre: at most 0.2 m an axis, so that 50,000 points of a
  // voxel do not overflow.
  void add_mm(std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
    ++count;
    sum_mm[0] += x;
    sum_mm[1] += y;
    sum_mm[2] += z;
    const std::array<std::int32_t, 6> products{x * x, x * y, x * z, y * y, y * z, z * z};
    for (std::size_t i = 0; i < 6; ++i) products_mm2[i] += products[i];
  }
  void add(const Moments& other, std::int32_t sign) noexcept {
    count += sign * other.count;
    for (std::size_t i = 0; i < 3; ++i) sum_mm[i] += sign * other.sum_mm[i];
    for (std::size_t i = 0; i < 6; ++i) products_mm2[i] += sign * other.products_mm2[i];
  }
  // From the voxel's centre; count > 0.
  [[nodiscard]] Vec3f mean_m() const noexcept {
    return Vec3f(static_cast<float>(sum_mm[0]), static_cast<float>(sum_mm[1]),
                 static_cast<float>(sum_mm[2])) *
           (1e-3F / static_cast<float>(count));
  }
};

// m²; count > 0.
[[nodiscard]] inline Mat3f covariance(const Moments& m) noexcept {
  const auto sum = [&m](std::size_t i) { return static_cast<float>(m.sum_mm[i]) * 1e-3F; };
  const auto product = [&m](std::size_t i) {
    return static_cast<float>(m.products_mm2[i]) * 1e-6F;
  };
  const auto count = static_cast<float>(m.count);
  const Vec3f mean = Vec3f(sum(0), sum(1), sum(2)) / count;
  Mat3f products;
  products << product(0), product(1), product(2), product(1), product(3), product(4), product(2),
      product(4), product(5);
  return products / count - mean * mean.transpose();
}

}  // namespace convexcut::robust
