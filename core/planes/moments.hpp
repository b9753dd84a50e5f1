// SPDX-License-Identifier: Apache-2.0
//
// First and second moments of a set of points: what a plane fit, and the merging of two sets, need
// of them.
#pragma once

#include <cstddef>
#include <span>

#include "core/geometry.hpp"
#include "core/planes/plane_patch.hpp"

namespace convexcut {

// The principal axes of a set of points. Metres.
struct PlaneFit {
  Plane plane;              // through the mean, across the axis of the least spread
  double thickness = 0.0;   // standard deviations along the three axes, in rising order
  double mid_spread = 0.0;  // (of the population: divided by n)
  double long_spread = 0.0;
};

class Moments {
 public:
  // Of points given by columns, which are equally long.
  [[nodiscard]] static Moments of(std::span<const float> x, std::span<const float> y,
                                  std::span<const float> z) noexcept;

  // The union of two disjoint sets: T. F. Chan, G. H. Golub, R. J. LeVeque, "Algorithms for
  // computing the sample variance", The American Statistician 37, 1983.
  Moments& operator+=(const Moments& other) noexcept;

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] const Vec3& mean() const noexcept { return mean_; }

  // Of at least three points; the axes of what is degenerate (equal or collinear) are arbitrary.
  [[nodiscard]] PlaneFit fit() const noexcept;

  // The mean of the squared distances of the points from a plane.
  [[nodiscard]] double mean_square_distance(const Plane& plane) const noexcept;

 private:
  std::size_t count_ = 0;
  Vec3 mean_ = Vec3::Zero();
  Eigen::Matrix3d scatter_ = Eigen::Matrix3d::Zero();  // sum of (p − mean)(p − mean)ᵀ
};

}  // namespace convexcut
