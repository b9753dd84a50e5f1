// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "core/convex_cut/robust/pose.hpp"

namespace convexcut::robust {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kSamples = 6'000;
constexpr std::array<float, 5> kGatesM{0.25F, 0.15F, 0.10F, 0.07F, 0.07F};
constexpr double kNoiseM = 0.02;
// Neighbouring points share what is wrong with their surface: their information adds up slowly.
constexpr double kIndependent = 0.05;
constexpr double kRotationSigma = 0.01;  // radians

// The accepted plane that p lies on within the gate, or kNoPlane.
[[nodiscard]] std::int32_t plane_at(const Model& model, const PlaneGrids& grids, const Vec3f& p,
                                    float gate_m) noexcept {
  std::int32_t nearest = kNoPlane;
  float least = gate_m;
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Plane& plane = model.planes[k];
    const float height = std::abs(plane.height_of(p));
    if (!plane.accepted || height >= least || !grids.is_structure(k, p, 1)) continue;
    least = height;
    nearest = static_cast<std::int32_t>(k);
  }
  return nearest;
}

struct Equations {
  Mat6 information = Mat6::Zero();
  Vec6 gradient = Vec6::Zero();
  std::size_t points = 0;

  void add(const Vec3f& from_rig, const Plane& plane, float height) noexcept {
    Vec6 j;
    j << from_rig.cross(plane.normal).cast<double>(), plane.normal.cast<double>();
    const double relative = static_cast<double>(height) / kNoiseM;
    const double weight = kIndependent / (kNoiseM * kNoiseM) / (1.0 + relative * relative / 4.0);
    information += weight * j * j.transpose();
    gradient += weight * static_cast<double>(height) * j;
    ++points;
  }
};

}  // namespace

std::optional<RigPose> aligned(const CloudView& cloud, const Model& model, const PlaneGrids& grids,
                               const RigPose& guess, float position_sigma_m,
                               float least_share) noexcept {
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / kSamples);
  const double position_sigma = position_sigma_m;
  Vec6 prior;
  prior << Vec3::Constant(1.0 / (kRotationSigma * kRotationSigma)),
      Vec3::Constant(1.0 / (position_sigma * position_sigma));
  RigPose pose = guess;
  Vec6 moved = Vec6::Zero();
  std::size_t fitting = 0;
  for (const float gate_m : kGatesM) {
    Equations equations;
    for (std::size_t i = 0; i < cloud.size(); i += stride) {
      const float share = static_cast<float>(i) / static_cast<float>(cloud.size());
      const Vec3f p = pose.apply(point_of(cloud, i), share);
      const std::int32_t k = plane_at(model, grids, p, gate_m);
      if (k == kNoPlane) continue;
      const Plane& plane = model.planes[static_cast<std::size_t>(k)];
      equations.add(p - pose.position, plane, plane.height_of(p));
    }
    fitting = equations.points;
    equations.information += Mat6(prior.asDiagonal());
    equations.gradient += prior.cwiseProduct(moved);
    const Vec6 step = -equations.information.ldlt().solve(equations.gradient);
    moved += step;
    const Vec3f turn = step.head<3>().cast<float>();
    pose.r_window_from_level =
        Eigen::AngleAxisf(turn.norm(), turn.stableNormalized()).toRotationMatrix() *
        pose.r_window_from_level;
    pose.position += step.tail<3>().cast<float>();
  }
  const std::size_t samples = (cloud.size() + stride - 1) / stride;
  if (static_cast<float>(fitting) < least_share * static_cast<float>(samples)) return std::nullopt;
  return pose;
}

}  // namespace convexcut::robust
