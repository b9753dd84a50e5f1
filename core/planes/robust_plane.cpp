// SPDX-License-Identifier: Apache-2.0
#include "core/planes/robust_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace convexcut {
namespace {

constexpr std::size_t kSample = 256;  // of a cell's points decide on its plane
// Of triples of a set of which 60 % is on a plane, one in five is on it; of 24, 99.6 %.
constexpr int kTriples = 24;
constexpr int kRounds = 4;
// The start from all points is good enough when its loss is at most that of 15 % outliers: each of
// these costs 1, each point of the plane σ² / reach² = 1/9.
constexpr double kGoodLoss = 0.15 + 0.85 / 9.0;

// Numbers that look random and are always the same (Numerical Recipes, "quick and dirty").
class Sequence {
 public:
  [[nodiscard]] std::size_t below(std::size_t limit) noexcept {
    state_ = state_ * 1664525U + 1013904223U;
    return static_cast<std::size_t>((std::uint64_t{state_} * limit) >> 32U);
  }

 private:
  std::uint32_t state_ = 1;
};

[[nodiscard]] Vec3 point(const PlanePoints& points, std::size_t i) {
  return {static_cast<double>(points.x[i]), static_cast<double>(points.y[i]),
          static_cast<double>(points.z[i])};
}

}  // namespace

RobustPlaneFitter::RobustPlaneFitter(const PlaneOptions& options)
    : options_(options),
      reach_(static_cast<float>(3.0 * options.noise_m)),
      most_thickness_(1.5 * options.noise_m) {}

// The mean of min(d², reach²) in units of reach²: 0 … 1.
double RobustPlaneFitter::truncated_loss(const PlanePoints& points,
                                         const Plane& plane) const noexcept {
  constexpr std::size_t kLanes = 8;  // summed apart, so that the loop can be vectorised
  const FloatPlane p(plane);
  const float most = reach_ * reach_;
  std::array<float, kLanes> sums{};
  const std::size_t whole = points.size() / kLanes * kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t at = i + lane;
      const float d = p.signed_distance_m(points.x[at], points.y[at], points.z[at]);
      sums[lane] += std::min(d * d, most);
    }
  }
  for (std::size_t i = whole; i < points.size(); ++i) {
    const float d = p.signed_distance_m(points.x[i], points.y[i], points.z[i]);
    sums[i - whole] += std::min(d * d, most);
  }
  double sum = 0.0;
  for (const float part : sums) sum += static_cast<double>(part);
  return sum / (static_cast<double>(most) * static_cast<double>(points.size()));
}

Moments RobustPlaneFitter::inliers_of(const PlanePoints& points, const Plane& plane) {
  const FloatPlane p(plane);
  near_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float d = p.signed_distance_m(points.x[i], points.y[i], points.z[i]);
    if (std::abs(d) <= reach_) near_.add(points.x[i], points.y[i], points.z[i]);
  }
  return near_.moments();
}

Plane RobustPlaneFitter::concentrate(const PlanePoints& points, Plane plane, int rounds) {
  double loss = truncated_loss(points, plane);
  for (int round = 0; round < rounds; ++round) {
    const Moments near = inliers_of(points, plane);
    if (near.count() < 3) break;
    const Plane next = near.fit().plane;
    const double next_loss = truncated_loss(points, next);
    if (next_loss >= loss) break;
    loss = next_loss;
    plane = next;
  }
  return plane;
}

Plane RobustPlaneFitter::best_start(const PlanePoints& sample) const {
  Plane best = sample.moments().fit().plane;
  double least = truncated_loss(sample, best);
  if (least <= kGoodLoss) return best;
  Sequence random;
  for (int i = 0; i < kTriples; ++i) {
    const Vec3 a = point(sample, random.below(sample.size()));
    const Vec3 b = point(sample, random.below(sample.size()));
    const Vec3 c = point(sample, random.below(sample.size()));
    const Vec3 across = (b - a).cross(c - a);
    const double area = across.norm();
    if (area < options_.noise_m * options_.noise_m) continue;
    Plane plane{across / area, 0.0};
    plane.offset_m = plane.normal.dot(a);
    const double loss = truncated_loss(sample, plane);
    if (loss < least) {
      least = loss;
      best = plane;
    }
  }
  return best;
}

bool RobustPlaneFitter::fit(const PlanePoints& points, RobustFit& out) {
  if (points.size() < options_.least_cell_points) return false;
  const PlanePoints* sample = &points;
  if (points.size() > kSample) {
    sample_.clear();
    for (std::size_t i = 0; i < kSample; ++i) {
      const std::size_t at = i * points.size() / kSample;
      sample_.add(points.x[at], points.y[at], points.z[at]);
    }
    sample = &sample_;
  }
  Plane plane = concentrate(*sample, best_start(*sample), kRounds);
  if (sample != &points) plane = concentrate(points, plane, 1);
  out.inliers = inliers_of(points, plane);
  const auto least =
      static_cast<std::size_t>(options_.least_cell_share * static_cast<double>(points.size()));
  if (out.inliers.count() < std::max<std::size_t>(options_.least_cell_points, least)) return false;
  out.fit = out.inliers.fit();
  const bool sheet = out.fit.thickness <= most_thickness_;
  const bool more_than_a_line =
      out.fit.mid_spread >= std::max(2.0 * out.fit.thickness, options_.noise_m);
  return sheet && more_than_a_line;
}

}  // namespace convexcut
