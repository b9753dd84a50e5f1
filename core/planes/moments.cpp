// SPDX-License-Identifier: Apache-2.0
#include "core/planes/moments.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace convexcut {

Moments Moments::of(std::span<const float> x, std::span<const float> y,
                    std::span<const float> z) noexcept {
  Moments moments;
  if (x.empty()) return moments;
  // About the first point: differences of near points are exact where squares of far ones are not.
  const Vec3 origin(static_cast<double>(x[0]), static_cast<double>(y[0]),
                    static_cast<double>(z[0]));
  double sx = 0, sy = 0, sz = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = static_cast<double>(x[i]) - origin.x();
    const double dy = static_cast<double>(y[i]) - origin.y();
    const double dz = static_cast<double>(z[i]) - origin.z();
    sx += dx;
    sy += dy;
    sz += dz;
    xx += dx * dx;
    xy += dx * dy;
    xz += dx * dz;
    yy += dy * dy;
    yz += dy * dz;
    zz += dz * dz;
  }
  const auto n = static_cast<double>(x.size());
  const Vec3 shift = Vec3(sx, sy, sz) / n;
  moments.count_ = x.size();
  moments.mean_ = origin + shift;
  moments.scatter_ << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  moments.scatter_ -= n * shift * shift.transpose();
  return moments;
}

Moments& Moments::operator+=(const Moments& other) noexcept {
  if (other.count_ == 0) return *this;
  const auto mine = static_cast<double>(count_);
  const auto theirs = static_cast<double>(other.count_);
  const Vec3 apart = other.mean_ - mean_;
  count_ += other.count_;
  mean_ += apart * (theirs / (mine + theirs));
  scatter_ += other.scatter_ + (mine * theirs / (mine + theirs)) * apart * apart.transpose();
  return *this;
}

PlaneFit Moments::fit() const noexcept {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(scatter_ / static_cast<double>(std::max<std::size_t>(count_, 1)));
  const auto spread = [&axes](Eigen::Index i) {
    return std::sqrt(std::max(0.0, axes.eigenvalues()[i]));
  };
  PlaneFit fit;
  fit.plane.normal = axes.eigenvectors().col(0).normalized();
  fit.plane.offset_m = fit.plane.normal.dot(mean_);
  if (fit.plane.offset_m < 0.0) {
    fit.plane.normal = -fit.plane.normal;
    fit.plane.offset_m = -fit.plane.offset_m;
  }
  fit.thickness = spread(0);
  fit.mid_spread = spread(1);
  fit.long_spread = spread(2);
  return fit;
}

double Moments::mean_square_distance(const Plane& plane) const noexcept {
  if (count_ == 0) return 0.0;
  const double off = plane.signed_distance_m(mean_);
  const double spread = plane.normal.dot(scatter_ * plane.normal) / static_cast<double>(count_);
  return off * off + spread;
}

}  // namespace convexcut
