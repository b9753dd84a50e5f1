// SPDX-License-Identifier: Apache-2.0
//
// Sums over the points of a voxel: their number, mean and covariance. Whole numbers (millimetres
// from the voxel's centre), so that what was added can be taken away again without a trace.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include <Eigen/Eigenvalues>

#include "core/convex_cut/robust/shape_kernels.hpp"
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

// Sums over several voxels, about one of their centres. Four at a time, as every processor that is
// supported can; the compilers' vectors are what Eigen's are made of.
class Spread {
  using Four = float __attribute__((vector_size(16)));

 public:
  Spread() = default;

  // From the common centre to the moments' own, in metres, as add() takes it.
  class Shift {
   public:
    constexpr Shift() noexcept : Shift(0.0F, 0.0F, 0.0F) {}
    constexpr Shift(float x, float y, float z) noexcept
        : own_{x, y, z, 0.0F},
          rows_first_{x, y, z, y},
          columns_first_{x, x, x, y},
          rows_last_{z, y, z, z},
          columns_last_{x, y, y, z} {}

   private:
    friend class Spread;
    Four own_, rows_first_, columns_first_, rows_last_, columns_last_;
  };

  void add(const Moments& m, const Shift& shift = {}) noexcept {
    const Four sums = four_at(m.sum_mm.data()) * Four{1e-3F, 1e-3F, 1e-3F, 1.0F};
    const Four n = __builtin_shufflevector(sums, sums, 3, 3, 3, 3);
    sums_ += sums + n * shift.own_;
    first_ += product(four_at(m.products_mm2.data()), n, rows_first(sums), columns_first(sums),
                      shift.rows_first_, shift.columns_first_);
    last_ += product(four_at(m.products_mm2.data() + 2), n, rows_last(sums), columns_last(sums),
                     shift.rows_last_, shift.columns_last_);
  }
  [[nodiscard]] float count() const noexcept { return sums_[3]; }
  void store(SpreadColumns& to, std::size_t i) const noexcept {
    to.x[i] = sums_[0];
    to.y[i] = sums_[1];
    to.z[i] = sums_[2];
    to.count[i] = sums_[3];
    to.xx[i] = first_[0];
    to.xy[i] = first_[1];
    to.xz[i] = first_[2];
    to.yy[i] = first_[3];
    to.yz[i] = last_[2];
    to.zz[i] = last_[3];
  }
  // m²; count() > 0.
  [[nodiscard]] Mat3f covariance() const noexcept {
    const Vec3f mean = Vec3f(sums_[0], sums_[1], sums_[2]) / count();
    Mat3f products;
    products << first_[0], first_[1], first_[2], first_[1], first_[3], last_[2], first_[2],
        last_[2], last_[3];
    return products / count() - mean * mean.transpose();
  }

 private:
  using FourInts = std::int32_t __attribute__((vector_size(16)));

  [[nodiscard]] static Four four_at(const std::int32_t* values) noexcept {
    FourInts ints;
    std::memcpy(&ints, values, sizeof(ints));
    return __builtin_convertvector(ints, Four);
  }
  // Of products xx xy xz yy yz zz as a matrix's lower triangle, the first four and the last four.
  [[nodiscard]] static Four rows_first(Four v) noexcept {
    return __builtin_shufflevector(v, v, 0, 1, 2, 1);
  }
  [[nodiscard]] static Four columns_first(Four v) noexcept {
    return __builtin_shufflevector(v, v, 0, 0, 0, 1);
  }
  [[nodiscard]] static Four rows_last(Four v) noexcept {
    return __builtin_shufflevector(v, v, 2, 1, 2, 2);
  }
  [[nodiscard]] static Four columns_last(Four v) noexcept {
    return __builtin_shufflevector(v, v, 0, 1, 1, 2);
  }
  [[nodiscard]] static Four product(Four own_mm2, Four n, Four sum_of_row, Four sum_of_column,
                                    Four shift_of_row, Four shift_of_column) noexcept {
    return own_mm2 * 1e-6F + shift_of_row * sum_of_column + sum_of_row * shift_of_column +
           n * shift_of_row * shift_of_column;
  }

  Four sums_{};  // and the number of points
  Four first_{}, last_{};
};

}  // namespace convexcut::robust
