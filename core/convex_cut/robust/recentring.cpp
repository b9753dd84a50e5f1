// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/recentring.hpp"

#include <algorithm>
#include <cmath>

namespace convexcut::robust {
namespace {

constexpr float kNoiseM = 0.02F;
constexpr float kMostWeight = 20.0F;
constexpr float kIndependent = 0.2F;
constexpr float kOffsetSigmaM = 0.03F;
constexpr float kTiltSigma = 0.01F;  // radians

}  // namespace

Plane recentred(const Model& model, const PlaneGrids& grids, std::size_t k,
                std::span<const Surfel> revolution) noexcept {
  const Plane& known = model.planes[k];
  const PlaneGrid& grid = grids.grid(k);
  const Vec3f middle = grid.centre(known, grid.columns / 2, grid.rows / 2);
  const Vec3f prior(1.0F / (kOffsetSigmaM * kOffsetSigmaM), 1.0F / (kTiltSigma * kTiltSigma),
                    1.0F / (kTiltSigma * kTiltSigma));
  Vec3f change = Vec3f::Zero();  // of the offset, and of the normal along the grid's axes
  Plane plane = known;
  for (const float gate_m : {0.10F, 0.07F, 0.05F}) {
    Mat3f information = prior.asDiagonal();
    Vec3f gradient = Vec3f::Zero();
    for (const Surfel& surfel : revolution) {
      if (!surfel.supported) continue;
      const Vec3f& p = surfel.mean;
      if (std::abs(plane.height_of(p)) > gate_m || !grids.is_structure(k, p, 0)) continue;
      const float weight = kIndependent / (kNoiseM * kNoiseM) *
                           std::min(static_cast<float>(surfel.points), kMostWeight);
      const Vec3f j(1.0F, grid.along.dot(p - middle), grid.up.dot(p - middle));
      information += weight * j * j.transpose();
      gradient -= weight * known.height_of(p) * j;
    }
    change = information.ldlt().solve(gradient);
    plane.normal = (known.normal + change[1] * grid.along + change[2] * grid.up).normalized();
    plane.offset = change[0] - plane.normal.dot(middle) + known.height_of(middle);
  }
  return plane;
}

}  // namespace convexcut::robust
