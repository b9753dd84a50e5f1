// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/plane_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace convexcut::robust {
namespace {

// A surfel agrees with a plane only when it is this near.
constexpr float kPlaneGateM = 0.06F;
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
constexpr float kMostWeight = 20.0F;
constexpr float kRefineReachM = 0.3F;
constexpr std::array<float, 4> kGatesM{0.10F, 0.07F, 0.05F, 0.04F};  // of the fit, one by one
// Of a wall, against the floor: less is the noise of its fit, and more the wall's own. So is what
// is farther off at floor and ceiling than things hang before a wall, or blinds behind it.
constexpr float kLeastLean = 0.008F;
constexpr float kMostLean = 0.025F;
constexpr float kMostOffM = 0.035F;
// Of a small plane: by how much its normal may differ from the mean of its surfels'.
constexpr float kMixedSine = 0.035F;
constexpr std::array<float, 2> kGatesOfOneM{0.04F, 0.04F};
constexpr float kOnPlaneM = 0.02F;
constexpr float kManyBeside = 0.05F;          // of all
constexpr std::uint32_t kLargeSurfels = 150;  // of a wall; smaller ones may be anything

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

// Of the surfels of a fit. Two at a time, as every processor that is supported can; the compilers'
// vectors are what Eigen's are made of.
class WeightedSums {
  using Two = double __attribute__((vector_size(16)));

 public:
  void add(double x, double y, double z, double weight) noexcept {
    const double wz = weight * z;
    const Two wx_wy = Two{weight, weight} * Two{x, y};
    const Two wy_wz{wx_wy[1], wz};
    xx_xy_ += wx_wy * Two{x, x};
    xz_x_ += Two{wz, weight} * Two{x, x};
    yy_yz_ += wy_wz * Two{y, y};
    y_z_ += wy_wz;
    zz_weight_ += Two{wz * z, weight};
    ++count_;
  }
  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
  [[nodiscard]] Vec3 mean() const noexcept {
    return Vec3(xz_x_[1], y_z_[0], y_z_[1]) / zz_weight_[1];
  }
  // Its lower triangle.
  [[nodiscard]] Eigen::Matrix3d covariance() const noexcept {
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    products.col(0) << xx_xy_[0], xx_xy_[1], xz_x_[0];
    products.col(1).tail<2>() << yy_yz_[0], yy_yz_[1];
    products(2, 2) = zz_weight_[0];
    return products / zz_weight_[1] - mean() * mean().transpose();
  }

 private:
  Two xx_xy_{}, xz_x_{}, yy_yz_{}, y_z_{}, zz_weight_{};
  std::uint32_t count_ = 0;
};

// The numbers of the surfels whose bit is set, in their order.
template <class Visit>
void for_each_marked(const SurfelColumns& surfels, std::span<const std::uint64_t> bits,
                     Visit&& visit) noexcept {
  constexpr std::size_t kBits = 64;
  for (std::size_t word = 0; word * kBits < surfels.size; ++word) {
    for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
      visit(word * kBits + static_cast<std::size_t>(std::countr_zero(left)));
    }
  }
}

[[nodiscard]] Vec3f mean_of(const SurfelColumns& surfels, std::size_t i) noexcept {
  using C = SurfelColumns;
  return {surfels.column(C::kX)[i], surfels.column(C::kY)[i], surfels.column(C::kZ)[i]};
}

[[nodiscard]] WeightedSums sums_of(const SurfelColumns& surfels,
                                   std::span<const std::uint64_t> bits) noexcept {
  const float* x = surfels.column(SurfelColumns::kX);
  const float* y = surfels.column(SurfelColumns::kY);
  const float* z = surfels.column(SurfelColumns::kZ);
  const float* weight = surfels.column(SurfelColumns::kWeight);
  WeightedSums sums;
  for_each_marked(surfels, bits, [&](std::size_t i) {
    sums.add(static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i]),
             static_cast<double>(weight[i]));
  });
  return sums;
}

// The mean of the normals, by weight, on the side of `normal`; lines have none.
[[nodiscard]] Vec3f mean_normal(const SurfelColumns& surfels, std::span<const std::uint64_t> bits,
                                const Vec3f& normal) noexcept {
  using C = SurfelColumns;
  Vec3f sum = Vec3f::Zero();
  for_each_marked(surfels, bits, [&](std::size_t i) {
    if (surfels.column(C::kBar)[i] < 0.0F) return;
    const Vec3f n(surfels.column(C::kU)[i], surfels.column(C::kV)[i], surfels.column(C::kW)[i]);
    sum += std::copysign(surfels.column(C::kWeight)[i], n.dot(normal)) * n;
  });
  const float length = sum.norm();
  return length > 0.0F ? Vec3f(sum / length) : normal;
}

// Where some surfels are along an axis.
class Stretch {
 public:
  void add(float at_m) noexcept {
    sum_m_ += at_m;
    squares_m2_ += at_m * at_m;
    ++count_;
  }
  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
  [[nodiscard]] bool is_beside(const Stretch& other) const noexcept {
    return std::abs(mean_m() - other.mean_m()) > deviation_m() + other.deviation_m();
  }

 private:
  [[nodiscard]] float mean_m() const noexcept {
    return sum_m_ / static_cast<float>(std::max(count_, 1U));
  }
  [[nodiscard]] float deviation_m() const noexcept {
    const float variance =
        squares_m2_ / static_cast<float>(std::max(count_, 1U)) - mean_m() * mean_m();
    return std::sqrt(std::max(variance, 0.0F));
  }
  float sum_m_ = 0.0F, squares_m2_ = 0.0F;
  std::uint32_t count_ = 0;
};

// Whether many of the surfels marked are off the plane, side by side with those on it: not books
// among books.
[[nodiscard]] bool has_others_beside(const SurfelColumns& surfels,
                                     std::span<const std::uint64_t> bits,
                                     const Plane& plane) noexcept {
  const Vec3f along = Vec3f::UnitZ().cross(plane.normal).normalized();
  Stretch on_along, on_up, off_along, off_up, all;
  for_each_marked(surfels, bits, [&](std::size_t i) {
    const Vec3f mean = mean_of(surfels, i);
    const float height_m = std::abs(plane.height_of(mean));
    all.add(0.0F);
    if (height_m < kOnPlaneM) {
      on_along.add(along.dot(mean));
      on_up.add(mean.z());
    }
    if (height_m > kPlaneGateM) {
      off_along.add(along.dot(mean));
      off_up.add(mean.z());
    }
  });
  return static_cast<float>(off_up.count()) >= kManyBeside * static_cast<float>(all.count()) &&
         (on_along.is_beside(off_along) || on_up.is_beside(off_up));
}

// Of all planes with that normal through a surfel marked, the one that most of them lie on.
[[nodiscard]] Plane best_across(const SurfelColumns& surfels, std::span<const std::uint64_t> bits,
                                const Vec3f& normal) noexcept {
  Plane best;
  for_each_marked(surfels, bits, [&](std::size_t i) {
    Plane plane;
    plane.normal = normal;
    plane.offset = -normal.dot(mean_of(surfels, i));
    for_each_marked(surfels, bits, [&](std::size_t other) {
      plane.surfels += std::abs(plane.height_of(mean_of(surfels, other))) < kOnPlaneM ? 1U : 0U;
    });
    if (plane.surfels > best.surfels) best = plane;
  });
  return best;
}

struct Middle {
  Vec3f mean = Vec3f::Zero();
  float half_height_m = 0.0F;
};

// Of the plane's surfels within the last gate, by weight.
[[nodiscard]] Middle middle_of(const Model& model, std::size_t plane) noexcept {
  float weights = 0.0F;
  float bottom_m = std::numeric_limits<float>::max();
  float top_m = std::numeric_limits<float>::lowest();
  Vec3f sum = Vec3f::Zero();
  for (const Surfel& surfel : model.surfels) {
    if (surfel.plane != static_cast<std::int32_t>(plane) ||
        std::abs(model.planes[plane].height_of(surfel.mean)) > kGatesM.back()) {
      continue;
    }
    const float weight = std::min(static_cast<float>(surfel.points), kMostWeight);
    weights += weight;
    sum += weight * surfel.mean;
    bottom_m = std::min(bottom_m, surfel.mean.z());
    top_m = std::max(top_m, surfel.mean.z());
  }
  return {sum / std::max(weights, 1.0F), (top_m - bottom_m) / 2};
}

}  // namespace

const Plane* largest_floor(const Model& model) noexcept {
  const Plane* floor = nullptr;
  for (const Plane& plane : model.planes) {
    if (plane.normal.z() < kNearlyHorizontal) continue;
    if (floor == nullptr || plane.surfels > floor->surfels) floor = &plane;
  }
  return floor;
}

Vec3f up_of(const Model& model) noexcept {
  const Plane* floor = largest_floor(model);
  return floor == nullptr ? Vec3f(Vec3f::UnitZ()) : floor->normal;
}

PlaneSearch::PlaneSearch(std::size_t max_surfels)
    : left_(max_surfels), near_(max_surfels), sampled_(2 * kTested) {
  agree_.resize(max_surfels / 64 + 1);
  taken_.resize(max_surfels + SurfelColumns::kPadding);
}

void PlaneSearch::run(Model& model, const Vec3f& origin) noexcept {
  model.planes.clear();
  random_ = 1;
  take_left(model);
  int failures = 0;
  while (left_.size > kLeastSurfels && model.planes.size() < kMostPlanes &&
         failures < kMostFailures) {
    Plane plane = best_trial(model);
    if (plane.surfels < kLeastSurfels) {
      ++failures;
      continue;
    }
    const Plane trial = plane;
    if (refine(plane) < kLeastSurfels) {
      ++failures;
      take_agreeing(left_, trial, kPlaneGateM / 2, taken_.data());
      continue;
    }
    if (plane.height_of(origin) < 0.0F) {
      plane.normal = -plane.normal;
      plane.offset = -plane.offset;
    }
    plane.vertical = std::abs(plane.normal.z()) < kVertical;
    claim(model, plane);
  }
  square_walls(model);
}

// Large walls that lean a little against the floor were fitted through what hangs before or behind
// them: by what lies near them, but upright.
void PlaneSearch::square_walls(Model& model) noexcept {
  const Plane* floor = largest_floor(model);
  if (floor == nullptr) return;
  const Vec3f up = floor->normal;
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    Plane& plane = model.planes[k];
    const float lean = plane.normal.dot(up);
    if (!plane.vertical || plane.surfels < kLargeSurfels || std::abs(lean) < kLeastLean ||
        std::abs(lean) > kMostLean) {
      continue;
    }
    const Middle middle = middle_of(model, k);
    if (std::abs(lean) * middle.half_height_m > kMostOffM) continue;
    plane.normal = (plane.normal - lean * up).normalized();
    plane.offset = -plane.normal.dot(middle.mean);
  }
}

void PlaneSearch::take_left(Model& model) noexcept {
  using C = SurfelColumns;
  std::array<float*, C::kColumns> to{};
  for (std::size_t c = 0; c < C::kColumns; ++c) to[c] = left_.column(c);
  std::size_t count = 0;
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    Surfel& surfel = model.surfels[i];
    surfel.plane = kNoPlane;
    if (surfel.shape == Shape::other || !surfel.is_evidence()) continue;
    to[C::kX][count] = surfel.mean.x();
    to[C::kY][count] = surfel.mean.y();
    to[C::kZ][count] = surfel.mean.z();
    to[C::kU][count] = surfel.direction.x();
    to[C::kV][count] = surfel.direction.y();
    to[C::kW][count] = surfel.direction.z();
    to[C::kBar][count] = has_normal(surfel.shape) ? kNormalAgrees : -kLineAgrees;
    to[C::kWeight][count] = std::min(static_cast<float>(surfel.points), kMostWeight);
    left_.index[count++] = static_cast<std::uint32_t>(i);
  }
  left_.size = count;
}

std::size_t PlaneSearch::random_left() noexcept {
  random_ = random_ * 6364136223846793005U + 1442695040888963407U;  // Knuth, MMIX
  return static_cast<std::size_t>((random_ >> 33U) % left_.size);
}

// Every so manyth surfel.
const SurfelColumns& PlaneSearch::sample() noexcept {
  const std::size_t stride = left_.size / kTested;
  if (stride <= 1) return left_;
  sampled_.size = (left_.size + stride - 1) / stride;
  for (std::size_t c = 0; c <= SurfelColumns::kBar; ++c) {
    const float* from = left_.column(c);
    float* to = sampled_.column(c);
    for (std::size_t i = 0; i < sampled_.size; ++i) to[i] = from[i * stride];
  }
  return sampled_;
}

Plane PlaneSearch::best_trial(const Model& model) noexcept {
  const std::size_t stride = std::max<std::size_t>(1, left_.size / kTested);
  const SurfelColumns& tested = sample();
  Plane best;
  std::array<Plane, kPlanesAtOnce> planes;
  std::size_t count = 0;
  const auto test = [&] {
    const AgreeingCounts agreeing = count_agreeing(tested, planes, kPlaneGateM);
    for (std::size_t k = 0; k < count; ++k) {
      planes[k].surfels = static_cast<std::uint32_t>(agreeing[k] * stride);
      if (planes[k].surfels > best.surfels) best = planes[k];
    }
    count = 0;
  };
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::optional<Plane> plane = plane_through(model.surfels[left_.index[random_left()]]);
    if (!plane) continue;
    planes[count++] = *plane;
    if (count == kPlanesAtOnce) test();
  }
  if (count > 0) test();
  return best;
}

std::uint32_t PlaneSearch::refine(Plane& plane) noexcept {
  copy_near(left_, plane, kRefineReachM, near_);
  const std::uint32_t count = fit(plane, kGatesM);
  return count == 0 ? 0 : separated(plane, count);
}

// A fit through two upright surfaces that are parallel and side by side (a pillar and a lamp before
// it) agrees with the normals of neither: then the one of the two that more surfels lie on.
std::uint32_t PlaneSearch::separated(Plane& plane, std::uint32_t count) noexcept {
  if (count > kLargeSurfels || std::abs(plane.normal.z()) > kVertical) return count;
  const Vec3f normal = mean_normal(near_, agree_, plane.normal);
  if (normal.cross(plane.normal).norm() < kMixedSine) return count;
  Plane one = best_across(near_, agree_, normal);
  if (!has_others_beside(near_, agree_, one)) return count;
  const std::uint32_t count_of_one = fit(one, kGatesOfOneM);
  if (count_of_one == 0) return count;
  plane = one;
  return count_of_one;
}

// Fits the plane to those of near_ within each gate, one by one; returns how many are in the last.
std::uint32_t PlaneSearch::fit(Plane& plane, std::span<const float> gates_m) noexcept {
  std::uint32_t count = 0;
  for (const float gate_m : gates_m) {
    mark_agreeing(near_, plane, gate_m, agree_);
    const WeightedSums sums = sums_of(near_, agree_);
    if (sums.count() < kLeastSurfels) return 0;
    count = sums.count();
    const Vec3 mean = sums.mean();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(sums.covariance());
    if (axes.eigenvalues()[1] > kLine2) plane.normal = axes.eigenvectors().col(0).cast<float>();
    plane.offset = -plane.normal.dot(mean.cast<float>());
  }
  return count;
}

void PlaneSearch::claim(Model& model, const Plane& plane) noexcept {
  const std::size_t count = take_agreeing(left_, plane, kPlaneGateM, taken_.data());
  for (std::size_t i = 0; i < count; ++i) {
    model.surfels[taken_[i]].plane = static_cast<std::int32_t>(model.planes.size());
  }
  model.planes.push_back(plane);
  model.planes.back().surfels = static_cast<std::uint32_t>(count);
}

}  // namespace convexcut::robust
