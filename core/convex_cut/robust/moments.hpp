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
  std::int32_t count = 0;
  std::array<std::int32_t, 3> sum_mm{};
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

// Sums over several voxels, about one of their centres.
class Spread {
 public:
  // shift_m: from the common centre to the moments' own.
  void add(const Moments& m, const Vec3f& shift_m) noexcept {
    const auto n = static_cast<float>(m.count);
    std::array<float, 3> sum{};
    for (std::size_t i = 0; i < 3; ++i) {
      sum[i] = static_cast<float>(m.sum_mm[i]) * 1e-3F;
      sum_[i] += sum[i] + n * shift_m[static_cast<Eigen::Index>(i)];
    }
    const std::array<float, 3> shift{shift_m.x(), shift_m.y(), shift_m.z()};
    for (std::size_t i = 0; i < 6; ++i) {
      const std::size_t row = kRow[i];
      const std::size_t column = kColumn[i];
      products_[i] += static_cast<float>(m.products_mm2[i]) * 1e-6F + shift[row] * sum[column] +
                      sum[row] * shift[column] + n * shift[row] * shift[column];
    }
    count_ += n;
  }
  [[nodiscard]] float count() const noexcept { return count_; }
  // m²; count() > 0.
  [[nodiscard]] Mat3f covariance() const noexcept {
    Mat3f covariance;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto row = static_cast<Eigen::Index>(kRow[i]);
      const auto column = static_cast<Eigen::Index>(kColumn[i]);
      covariance(row, column) = covariance(column, row) =
          products_[i] / count_ - sum_[kRow[i]] / count_ * (sum_[kColumn[i]] / count_);
    }
    return covariance;
  }

 private:
  // Of products: xx xy xz yy yz zz, as the lower triangle of a matrix.
  static constexpr std::array<std::size_t, 6> kRow{0, 1, 2, 1, 2, 2};
  static constexpr std::array<std::size_t, 6> kColumn{0, 0, 0, 1, 1, 2};

  float count_ = 0.0F;
  std::array<float, 3> sum_{};
  std::array<float, 6> products_{};
};

}  // namespace convexcut::robust
