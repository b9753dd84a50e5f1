// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/convex_cut/robust/pose.hpp"
#include "core/convex_cut/robust/shape.hpp"

namespace convexcut::robust {
namespace {

constexpr float kMostTilt = 0.978F;       // cosine of 12°
constexpr float kCountedWithin = 0.035F;  // radians
constexpr float kClearlyMore = 1.1F;

// Whether a surface with that cosine to the vertical is level or upright within `gate` radians.
[[nodiscard]] bool is_level(float cosine, float gate) noexcept { return cosine > std::cos(gate); }
[[nodiscard]] bool is_upright(float cosine, float gate) noexcept { return cosine < std::sin(gate); }

// The shortest rotation that takes `up` to z. They are at most 12° apart; Eigen's FromTwoVectors
// provides for opposite ones too, by a decomposition that takes longer to compile than all else
// here.
[[nodiscard]] Mat3f make_upright(const Vec3f& up) noexcept {
  const Vec3f from = up.normalized();
  const Vec3f axis = from.cross(Vec3f::UnitZ());
  const float twice_w = std::sqrt((1.0F + from.z()) * 2.0F);
  const Vec3f v = axis / twice_w;
  return Eigen::Quaternionf(0.5F * twice_w, v.x(), v.y(), v.z()).toRotationMatrix();
}

}  // namespace

Mat3f upright_correction(const VoxelMap& revolution) noexcept {
  const auto for_each_normal = [&](auto&& visit) {
    for (const Voxel& voxel : revolution.voxels()) {
      if (has_normal(voxel.shape)) visit(voxel.direction);
    }
  };
  const auto explained = [&](const Vec3f& up) {
    std::uint32_t count = 0;
    for_each_normal([&](const Vec3f& n) {
      const float cosine = std::abs(n.dot(up));
      count += is_level(cosine, kCountedWithin) || is_upright(cosine, kCountedWithin) ? 1U : 0U;
    });
    return static_cast<float>(count);
  };
  Vec3f up = Vec3f::UnitZ();
  for (const float gate : {0.2F, 0.12F, 0.07F, 0.05F, 0.05F}) {
    Mat3f sum = Mat3f::Zero();  // least along its first axis: along level normals, across upright
    for_each_normal([&](const Vec3f& n) {
      const float cosine = std::abs(n.dot(up));
      if (is_level(cosine, gate)) sum -= n * n.transpose();
      if (is_upright(cosine, gate)) sum += n * n.transpose();
    });
    Eigen::SelfAdjointEigenSolver<Mat3f> axes;
    axes.computeDirect(sum);
    Vec3f better = axes.eigenvectors().col(0);
    if (better.z() < 0.0F) better = -better;
    if (better.z() > kMostTilt) up = better;
  }
  if (explained(up) <= kClearlyMore * explained(Vec3f::UnitZ())) return Mat3f::Identity();
  return make_upright(up);
}

}  // namespace convexcut::robust
