// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/layer_edge.hpp"

#include <cmath>

#include "core/convex_cut/robust/moments.hpp"

namespace convexcut::robust {
namespace {

// Across one ring of the lidar, points are spread by noise alone: no slope is read from that.
constexpr float kNoSpread2 = 1e-4F;  // m²

// Of the points of several voxels.
class Pool {
 public:
  void add(const Voxel& voxel) noexcept {
    if (voxel.moments.count <= 0) return;
    const auto points = static_cast<float>(voxel.moments.count);
    const Vec3f mean = voxel.mean();
    if (points_ == 0.0F) about_ = mean;
    const Vec3f off = mean - about_;
    points_ += points;
    sum_ += points * off;
    products_ += points * (covariance(voxel.moments) + off * off.transpose());
  }
  [[nodiscard]] bool is_empty() const noexcept { return points_ == 0.0F; }
  [[nodiscard]] Vec3f mean() const noexcept { return about_ + sum_ / points_; }
  [[nodiscard]] Mat3f spread() const noexcept {
    const Vec3f off = sum_ / points_;
    return products_ / points_ - off * off.transpose();
  }

 private:
  float points_ = 0.0F;
  Vec3f about_ = Vec3f::Zero();  // the first mean: sums about the origin would lose digits
  Vec3f sum_ = Vec3f::Zero();
  Mat3f products_ = Mat3f::Zero();
};

// The voxel, and those before and behind it that lie on the plane: a border of voxels may run
// through the noise of a wall, or between it and what hangs on it.
[[nodiscard]] Pool pool_across(const Model& model, const VoxelMap& map, std::size_t voxel,
                               std::size_t plane) noexcept {
  Pool pool;
  pool.add(map.voxels()[voxel]);
  Eigen::Index axis = 0;
  model.planes[plane].normal.cwiseAbs().maxCoeff(&axis);
  for (const float step : {-kVoxelM, kVoxelM}) {
    Vec3f at = model.surfels[voxel].mean;
    at[axis] += step;
    const auto other = static_cast<std::size_t>(map.find(key_of(place_of(at))));
    if (other >= model.surfels.size()) continue;
    if (model.surfels[other].plane == static_cast<std::int32_t>(plane)) {
      pool.add(map.voxels()[other]);
    }
  }
  return pool;
}

// By which the height over the plane grows along it.
[[nodiscard]] Vec3f slope_of(const Mat3f& spread, const Vec3f& normal) noexcept {
  const Vec3f along = Vec3f::UnitZ().cross(normal).normalized();
  const Vec3f up = normal.cross(along);
  const float aa = along.dot(spread * along) + kNoSpread2;
  const float au = along.dot(spread * up);
  const float uu = up.dot(spread * up) + kNoSpread2;
  const float ah = along.dot(spread * normal);
  const float uh = up.dot(spread * normal);
  const float determinant = aa * uu - au * au;
  return ((ah * uu - uh * au) * along + (uh * aa - ah * au) * up) / determinant;
}

}  // namespace

std::optional<LayerEdge> LayerEdge::of(const Model& model, const PlaneGrids& grids,
                                       const VoxelMap& map, std::size_t voxel,
                                       std::size_t plane) noexcept {
  const Plane& wall = model.planes[plane];
  const float layer_m = grids.layer_near(plane, model.surfels[voxel].mean);
  if (layer_m == 0.0F) return std::nullopt;
  const Pool pool = pool_across(model, map, voxel, plane);
  if (pool.is_empty()) return std::nullopt;
  const float side = layer_m > 0.0F ? 1.0F : -1.0F;
  const Vec3f mean = pool.mean();
  LayerEdge edge;
  edge.slope_ = side * slope_of(pool.spread(), wall.normal);
  const float height_m = side * (wall.height_of(mean) - wall.face_m);
  edge.beyond_m_ = height_m - std::abs(layer_m) / 2 - edge.slope_.dot(mean);
  return edge;
}

}  // namespace convexcut::robust
