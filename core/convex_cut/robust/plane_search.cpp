// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/plane_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace convexcut::robust {
namespace {

constexpr int kTrials = 48;
constexpr std::size_t kTested = 1'500;  // surfels a trial is tested on, about
constexpr int kMostFailures = 3;
// |cos| between a surfel's normal, or its line, and the plane's normal.
constexpr float kNormalAgrees = 0.85F;
constexpr float kLineAgrees = 0.25F;
// Trials this near to vertical or horizontal are taken as exactly so.
constexpr float kNearlyVertical = 0.12F;
constexpr float kNearlyHorizontal = 0.993F;
constexpr float kVertical = 0.35F;
// A variance along the plane below this is one line of points, which has no normal.
constexpr double kLine2 = 0.02;
constexpr double kMostWeight = 20.0;
constexpr float kRefineReachM = 0.3F;

[[nodiscard]] std::optional<Plane> plane_through(const Surfel& surfel) noexcept {
  Vec3f n = surfel.direction;
  if (surfel.shape == Shape::line) {
    if (std::abs(n.z()) > 0.3F) return std::nullopt;
    n = Vec3f(-n.y(), n.x(), 0.0F).normalized();
  } else if (std::abs(n.z()) < kNearlyVertical) {
    n.z() = 0.0F;
    n.normalize();
  } else if (std::abs(n.z()) > kNearlyHorizontal) {
    n = Vec3f::UnitZ();
  }
  Plane plane;
  plane.normal = n;
  plane.offset = -n.dot(surfel.mean);
  return plane;
}

[[nodiscard]] double weight_of(const Surfel& surfel) noexcept {
  return std::min(static_cast<double>(surfel.points), kMostWeight);
}

}  // namespace

bool agrees(const Surfel& surfel, const Plane& plane, float gate_m) noexcept {
  if (std::abs(plane.height_of(surfel.mean)) > gate_m) return false;
  const float cosine = std::abs(plane.normal.dot(surfel.direction));
  if (surfel.shape == Shape::plane) return cosine > kNormalAgrees;
  return surfel.shape == Shape::line && cosine < kLineAgrees;
}

void PlaneSearch::run(Model& model, const Vec3f& origin) noexcept {
  model.planes.clear();
  left_.clear();
  random_ = 1;
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    Surfel& surfel = model.surfels[i];
    surfel.plane = kNoPlane;
    if (surfel.shape != Shape::other && surfel.is_evidence()) {
      left_.push_back(static_cast<std::uint32_t>(i));
    }
  }
  int failures = 0;
  while (left_.size() > kLeastSurfels && model.planes.size() < kMostPlanes &&
         failures < kMostFailures) {
    Plane plane = best_trial(model);
    if (plane.surfels < kLeastSurfels) {
      ++failures;
      continue;
    }
    const Plane trial = plane;
    if (refine(model, plane) < kLeastSurfels) {
      ++failures;
      drop_near(model, trial);
      continue;
    }
    if (plane.height_of(origin) < 0.0F) {
      plane.normal = -plane.normal;
      plane.offset = -plane.offset;
    }
    plane.vertical = std::abs(plane.normal.z()) < kVertical;
    claim(model, plane);
  }
}

std::size_t PlaneSearch::random_left() noexcept {
  random_ = random_ * 6364136223846793005U + 1442695040888963407U;  // Knuth, MMIX
  return static_cast<std::size_t>((random_ >> 33U) % left_.size());
}

Plane PlaneSearch::best_trial(const Model& model) noexcept {
  const std::size_t stride = std::max<std::size_t>(1, left_.size() / kTested);
  Plane best;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::optional<Plane> plane = plane_through(model.surfels[left_[random_left()]]);
    if (!plane) continue;
    std::size_t agreeing = 0;
    for (std::size_t i = 0; i < left_.size(); i += stride) {
      agreeing += agrees(model.surfels[left_[i]], *plane, kPlaneGateM) ? 1U : 0U;
    }
    plane->surfels = static_cast<std::uint32_t>(agreeing * stride);
    if (plane->surfels > best.surfels) best = *plane;
  }
  return best;
}

std::uint32_t PlaneSearch::refine(const Model& model, Plane& plane) noexcept {
  near_.clear();
  for (const std::uint32_t i : left_) {
    if (std::abs(plane.height_of(model.surfels[i].mean)) < kRefineReachM) near_.push_back(i);
  }
  std::uint32_t count = 0;
  for (const float gate_m : {0.10F, 0.07F, 0.05F, 0.04F}) {
    double weight = 0.0;
    Vec3 sum = Vec3::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    count = 0;
    for (const std::uint32_t i : near_) {
      const Surfel& surfel = model.surfels[i];
      if (!agrees(surfel, plane, gate_m)) continue;
      const double w = weight_of(surfel);
      const Vec3 p = surfel.mean.cast<double>();
      weight += w;
      sum += w * p;
      products += w * p * p.transpose();
      ++count;
    }
    if (count < kLeastSurfels) return 0;
    const Vec3 mean = sum / weight;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(products / weight - mean * mean.transpose());
    if (axes.eigenvalues()[1] > kLine2) plane.normal = axes.eigenvectors().col(0).cast<float>();
    plane.offset = -plane.normal.dot(mean.cast<float>());
  }
  return count;
}

void PlaneSearch::claim(Model& model, const Plane& plane) noexcept {
  Plane claimed = plane;
  claimed.surfels = 0;
  std::size_t kept = 0;
  for (const std::uint32_t i : left_) {
    if (agrees(model.surfels[i], plane, kPlaneGateM)) {
      model.surfels[i].plane = static_cast<std::int32_t>(model.planes.size());
      ++claimed.surfels;
    } else {
      left_[kept++] = i;
    }
  }
  left_.resize(kept);
  model.planes.push_back(claimed);
}

void PlaneSearch::drop_near(const Model& model, const Plane& plane) noexcept {
  std::erase_if(left_,
                [&](std::uint32_t i) { return agrees(model.surfels[i], plane, kPlaneGateM / 2); });
}

}  // namespace convexcut::robust
