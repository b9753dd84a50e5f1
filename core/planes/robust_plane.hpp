// SPDX-License-Identifier: Apache-2.0
//
// The plane that most of a few points lie on, however the rest lie: principal components of a
// trimmed set, started from the whole set and from triples of points, and concentrated until they
// stand still (P. J. Rousseeuw, K. Van Driessen, "A fast algorithm for the minimum covariance
// determinant estimator", Technometrics 41, 1999; M. Hubert, P. J. Rousseeuw, K. Vanden Branden,
// "ROBPCA", Technometrics 47, 2005). The noise of the sensor is known, so points are trimmed at a
// known distance instead of a share of them: a plane may hold any share that the caller asks for.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/planes/plane_options.hpp"
#include "core/planes/point_columns.hpp"

namespace convexcut {

struct RobustFit {
  PlaneFit fit;     // of the inliers
  Moments inliers;  // the points at most `reach` from the plane
};

class RobustPlaneFitter {
 public:
  explicit RobustPlaneFitter(const PlaneOptions& options);

  // How far from its plane a point may be to belong to it: 3 σ of the noise. Metres.
  [[nodiscard]] float reach_m() const noexcept { return reach_; }

  // False when no plane holds enough of the points (PlaneOptions: least_cell_points,
  // least_cell_share), when these are no flat sheet (thicker than 1.5 σ of the noise), or no sheet
  // but a line (as of one beam of the lidar). The same points in the same order give the same fit.
  [[nodiscard]] bool fit(const PlanePoints& points, RobustFit& out);

  // 1.5 σ of the noise: an evenly filled slab within reach is thicker.
  [[nodiscard]] double most_thickness_m() const noexcept { return most_thickness_; }

 private:
  [[nodiscard]] Plane best_start(const PlanePoints& sample) const;
  [[nodiscard]] Plane concentrate(const PlanePoints& points, Plane plane, int rounds);
  [[nodiscard]] double truncated_loss(const PlanePoints& points, const Plane& plane) const noexcept;
  [[nodiscard]] Moments inliers_of(const PlanePoints& points, const Plane& plane);

  PlaneOptions options_;
  float reach_;
  double most_thickness_;
  PlanePoints sample_, near_;
};

}  // namespace convexcut
