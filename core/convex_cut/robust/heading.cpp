// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/convex_cut/robust/pose.hpp"

namespace convexcut::robust {
namespace {

constexpr float kUpright = 0.1F;   // |z| of a wall's normal at most
constexpr std::size_t kBins = 90;  // of 1°: walls that are square to each other count as one
constexpr float kRadiansPerBin = std::numbers::pi_v<float> / 2.0F / static_cast<float>(kBins);
constexpr std::array kWeights{1.0F, 2.0F, 3.0F, 2.0F, 1.0F};  // of a bin and its neighbours
constexpr float kGateBins = 3.0F;
constexpr int kRefinements = 2;

// 0 … 90, in bins.
[[nodiscard]] float square_angle(const Vec3f& normal) noexcept {
  const float angle = std::atan2(normal.y(), normal.x()) / kRadiansPerBin;
  const auto all = static_cast<float>(kBins);
  return std::min(angle - all * std::floor(angle / all), std::nextafter(all, 0.0F));
}

// The shorter way round, −45 … 45.
[[nodiscard]] float difference(float a, float b) noexcept {
  const auto all = static_cast<float>(kBins);
  return std::remainder(a - b, all);
}

[[nodiscard]] float fullest(const std::array<float, kBins>& bins) noexcept {
  std::size_t best = 0;
  float most = -1.0F;
  for (std::size_t i = 0; i < kBins; ++i) {
    float sum = 0.0F;
    for (std::size_t k = 0; k < kWeights.size(); ++k) {
      sum += kWeights.at(k) * bins.at((i + kBins + k - kWeights.size() / 2) % kBins);
    }
    if (sum <= most) continue;
    most = sum;
    best = i;
  }
  return static_cast<float>(best) + 0.5F;
}

}  // namespace

Mat3f wall_correction(const VoxelMap& revolution, const Mat3f& r_upright_from_level) noexcept {
  const auto for_each_angle = [&](auto&& visit) {
    for (const Voxel& voxel : revolution.voxels()) {
      if (!has_normal(voxel.shape)) continue;
      const Vec3f normal = r_upright_from_level * voxel.direction;
      if (std::abs(normal.z()) <= kUpright) visit(square_angle(normal));
    }
  };
  std::array<float, kBins> bins{};
  std::size_t count = 0;
  for_each_angle([&](float angle) {
    bins.at(static_cast<std::size_t>(angle)) += 1.0F;
    ++count;
  });
  if (count == 0) return Mat3f::Identity();
  float heading = fullest(bins);
  for (int i = 0; i < kRefinements; ++i) {
    float sum = 0.0F;
    float near = 0.0F;
    for_each_angle([&](float angle) {
      const float off = difference(angle, heading);
      if (std::abs(off) > kGateBins) return;
      sum += off;
      near += 1.0F;
    });
    heading += sum / std::max(near, 1.0F);
  }
  const float turn = difference(heading, 0.0F) * kRadiansPerBin;
  return Eigen::AngleAxisf(-turn, Vec3f::UnitZ()).toRotationMatrix();
}

}  // namespace convexcut::robust
