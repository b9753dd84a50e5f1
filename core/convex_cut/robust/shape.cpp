// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/shape.hpp"

#include <algorithm>

namespace convexcut::robust {
namespace {

constexpr float kFewPoints = 6.0F;
// A voxel alone has a normal only when a surface fills it.
constexpr std::int32_t kManyPoints = 12;
// The square of what a surface and the sensor's noise on it may be thick, root mean square.
constexpr float kThickness2 = 0.035F * 0.035F;
constexpr float kLeastNoise2 = 2e-4F;

}  // namespace

LocalShape local_shape(const Spread& spread) noexcept {
  if (spread.count() < kFewPoints) return {};
  Eigen::SelfAdjointEigenSolver<Mat3f> axes;
  axes.computeDirect(spread.covariance());
  const Vec3f& extent2 = axes.eigenvalues();  // increasing
  if (extent2[0] < kThickness2 && extent2[1] > 4.0F * std::max(extent2[0], kLeastNoise2)) {
    return {Shape::plane, axes.eigenvectors().col(0)};
  }
  if (extent2[1] < 2.0F * kThickness2 && extent2[2] > 6.0F * extent2[1]) {
    return {Shape::line, axes.eigenvectors().col(2)};
  }
  return {};
}

LocalShape shape_around(const VoxelMap& map, const Voxel& voxel) noexcept {
  Spread around;
  for_each_neighbour(map, voxel.key, [&](std::size_t index, const Lattice& step) {
    const Vec3f shift(static_cast<float>(step[0]), static_cast<float>(step[1]),
                      static_cast<float>(step[2]));
    around.add(map.voxels()[index].moments, shift * kVoxelM);
  });
  const LocalShape wide = local_shape(around);
  if (wide.shape == Shape::plane || voxel.moments.count <= kManyPoints) return wide;
  Spread alone;
  alone.add(voxel.moments, Vec3f::Zero());
  const LocalShape narrow = local_shape(alone);
  return narrow.shape == Shape::plane ? narrow : wide;
}

}  // namespace convexcut::robust
