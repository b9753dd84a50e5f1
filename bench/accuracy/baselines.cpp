// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/baselines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include "core/geometry.hpp"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace convexcut::bench {
namespace {

struct Plane {
  Vec3f normal = Vec3f::UnitZ();
  float offset = 0.0F;
  [[nodiscard]] float height_of(const Vec3f& p) const { return normal.dot(p) + offset; }
};

[[nodiscard]] Vec3f point_of(const CloudView& cloud, std::size_t i) {
  return {cloud.x[i], cloud.y[i], cloud.z[i]};
}

class HalfSpaceRansac {
 public:
  explicit HalfSpaceRansac(const CloudView& cloud) : cloud_(cloud) {
    const std::size_t stride = std::max<std::size_t>(1, cloud.size() / kTested);
    for (std::size_t i = 0; i < cloud.size(); i += stride) left_.push_back(point_of(cloud, i));
    all_ = left_;
  }

  void run(std::span<Label> labels) {
    for (int found = 0; found < kMostPlanes; ++found) {
      const std::optional<Plane> plane = best_trial();
      if (!plane) return;
      for (std::size_t i = 0; i < cloud_.size(); ++i) {
        if (std::abs(plane->height_of(point_of(cloud_, i))) < kInlierM) {
          labels[i] = Label::structure;
        }
      }
      std::erase_if(left_,
                    [&](const Vec3f& p) { return std::abs(plane->height_of(p)) < kInlierM; });
    }
  }

 private:
  static constexpr std::size_t kTested = 4'000;
  static constexpr int kTrials = 400;
  static constexpr int kMostPlanes = 12;
  static constexpr float kInlierM = 0.06F;
  static constexpr double kLeastShare = 0.01;
  static constexpr double kOneSide = 0.98;

  // A level plane through a point, or an upright one through two.
  [[nodiscard]] std::optional<Plane> trial() {
    const auto any = [this] { return left_[random_() % left_.size()]; };
    const Vec3f a = any();
    if (random_() % 3 == 0) return Plane{Vec3f::UnitZ(), -a.z()};
    const Vec3f b = any();
    const Vec3f across(a.y() - b.y(), b.x() - a.x(), 0.0F);
    if (across.norm() < 0.3F) return std::nullopt;
    return Plane{across.normalized(), -across.normalized().dot(a)};
  }

  [[nodiscard]] std::optional<Plane> best_trial() {
    std::optional<Plane> best;
    auto most = static_cast<std::size_t>(kLeastShare * static_cast<double>(all_.size()));
    for (int i = 0; i < kTrials && left_.size() > 2; ++i) {
      const std::optional<Plane> plane = trial();
      if (!plane) continue;
      const auto inliers = static_cast<std::size_t>(std::ranges::count_if(
          left_, [&](const Vec3f& p) { return std::abs(plane->height_of(p)) < kInlierM; }));
      if (inliers <= most || !is_on_one_side(*plane)) continue;
      most = inliers;
      best = plane;
    }
    return best;
  }

  [[nodiscard]] bool is_on_one_side(const Plane& plane) const {
    std::size_t above = 0;
    std::size_t below = 0;
    for (const Vec3f& p : all_) {
      const float height = plane.height_of(p);
      above += height > kInlierM ? 1U : 0U;
      below += height < -kInlierM ? 1U : 0U;
    }
    return static_cast<double>(std::min(above, below)) <=
           (1.0 - kOneSide) * static_cast<double>(all_.size());
  }

  CloudView cloud_;
  std::vector<Vec3f> left_, all_;
  // The same planes in every run. NOLINTNEXTLINE(cert-msc32-c,cert-msc51-cpp)
  std::mt19937 random_{1};
};

// The planes of the hull's facets, normals outwards.
[[nodiscard]] std::vector<Plane> hull_facets(const CloudView& cloud) {
  std::vector<coordT> coordinates;
  coordinates.reserve(3 * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (const float c : {cloud.x[i], cloud.y[i], cloud.z[i]}) {
      coordinates.push_back(static_cast<coordT>(c));
    }
  }
  qhT qh{};
  qh_zero(&qh, stderr);
  std::string options = "qhull Pp";
  const int failed = qh_new_qhull(&qh, 3, static_cast<int>(cloud.size()), coordinates.data(), False,
                                  options.data(), nullptr, stderr);
  std::vector<Plane> facets;
  if (failed == 0) {
    for (const facetT* f = qh.facet_list; f != nullptr && f->next != nullptr; f = f->next) {
      facets.push_back({Vec3f(static_cast<float>(f->normal[0]), static_cast<float>(f->normal[1]),
                              static_cast<float>(f->normal[2])),
                        static_cast<float>(f->offset)});
    }
  }
  qh_freeqhull(&qh, qh_ALL == 0 ? 1U : 0U);
  int long_left = 0;
  int bytes_left = 0;
  qh_memfreeshort(&qh, &long_left, &bytes_left);
  return facets;
}

}  // namespace

void label_farthest_column(const CloudView& cloud, std::span<Label> labels) {
  constexpr std::size_t kColumns = 360;
  constexpr float kBandM = 0.08F;
  std::array<float, kColumns> farthest{};
  const auto range = [&](std::size_t i) { return std::hypot(cloud.x[i], cloud.y[i]); };
  const auto column = [&](std::size_t i) {
    constexpr float kPi = std::numbers::pi_v<float>;
    const float turn = (std::atan2(cloud.y[i], cloud.x[i]) + kPi) / (2.0F * kPi);
    return std::min(static_cast<std::size_t>(turn * static_cast<float>(kColumns)), kColumns - 1);
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    farthest.at(column(i)) = std::max(farthest.at(column(i)), range(i));
  }
  if (cloud.size() == 0) return;
  const auto [low, high] = std::ranges::minmax(cloud.z);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool is = range(i) > farthest.at(column(i)) - kBandM || cloud.z[i] < low + kBandM ||
                    cloud.z[i] > high - kBandM;
    labels[i] = is ? Label::structure : Label::other;
  }
}

void label_half_space_ransac(const CloudView& cloud, std::span<Label> labels) {
  std::ranges::fill(labels, Label::other);
  HalfSpaceRansac(cloud).run(labels);
}

void label_hull(const CloudView& cloud, std::span<Label> labels) {
  constexpr float kBandM = 0.12F;
  const std::vector<Plane> facets = hull_facets(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3f p = point_of(cloud, i);
    const bool near = std::ranges::any_of(
        facets, [&](const Plane& facet) { return facet.height_of(p) > -kBandM; });
    labels[i] = near ? Label::structure : Label::other;
  }
}

}  // namespace convexcut::bench
