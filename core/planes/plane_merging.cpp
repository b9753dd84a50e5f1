// SPDX-License-Identifier: Apache-2.0
#include "core/planes/plane_merging.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

namespace convexcut {
namespace {

// A piece lies in a plane when the points' distances from it are, in the mean square, not more than
// these times the noise: noise alone has 1, the rest is left for what is not known of the plane.
constexpr double kMostDistance = 1.75;
constexpr double kMostThickness = 1.5;
// Between the normals of two pieces, with the uncertainty of the smaller one on top.
constexpr double kMostAngle = 10.0 * std::numbers::pi / 180.0;
constexpr double kMostAngleInAll = 25.0 * std::numbers::pi / 180.0;

// 1 σ of the direction of a fitted normal, radians.
[[nodiscard]] double normal_uncertainty(const PlaneFit& fit, std::size_t points) {
  return fit.thickness / (std::max(fit.mid_spread, 1e-9) * std::sqrt(static_cast<double>(points)));
}

}  // namespace

PlaneMerger::PlaneMerger(const PlaneOptions& options) : options_(options) {}

bool PlaneMerger::coplanar(const Region& large, const Region& small, Region& joined) const {
  const double most = kMostDistance * options_.noise_m;
  if (small.moments.mean_square_distance(large.fit.plane) > most * most) return false;
  const double angle = std::min(
      kMostAngle + 3.0 * normal_uncertainty(small.fit, small.moments.count()), kMostAngleInAll);
  const double cosine = std::abs(large.fit.plane.normal.dot(small.fit.plane.normal));
  if (cosine < std::cos(angle)) return false;
  joined.moments = large.moments;
  joined.moments += small.moments;
  joined.fit = joined.moments.fit();
  return joined.fit.thickness <= kMostThickness * options_.noise_m;
}

// Boxes that are at most largest_gap_m apart: a sweep along x.
void PlaneMerger::find_neighbours(std::span<const Planelet> planelets) {
  const auto count = static_cast<std::uint32_t>(planelets.size());
  const auto gap = static_cast<float>(options_.largest_gap_m);
  by_x_.resize(count);
  std::iota(by_x_.begin(), by_x_.end(), 0U);
  std::ranges::stable_sort(by_x_, {}, [&](std::uint32_t i) { return planelets[i].box.min().x(); });
  pairs_.clear();
  first_neighbour_.assign(std::size_t{count} + 1, 0);
  for (std::uint32_t k = 0; k < count; ++k) {
    const Eigen::AlignedBox3f& box = planelets[by_x_[k]].box;
    for (std::uint32_t m = k + 1; m < count; ++m) {
      const Eigen::AlignedBox3f& other = planelets[by_x_[m]].box;
      if (other.min().x() > box.max().x() + gap) break;
      if (box.squaredExteriorDistance(other) > gap * gap) continue;
      pairs_.push_back({std::min(by_x_[k], by_x_[m]), std::max(by_x_[k], by_x_[m])});
      ++first_neighbour_[by_x_[k]];
      ++first_neighbour_[by_x_[m]];
    }
  }
  std::ranges::sort(pairs_);
  // Counts become ends; filling from the back turns these into beginnings.
  std::partial_sum(first_neighbour_.begin(), first_neighbour_.end(), first_neighbour_.begin());
  neighbours_.resize(2 * pairs_.size());
  for (std::size_t i = pairs_.size(); i-- > 0;) {
    neighbours_[--first_neighbour_[pairs_[i].a]] = pairs_[i].b;
    neighbours_[--first_neighbour_[pairs_[i].b]] = pairs_[i].a;
  }
}

void PlaneMerger::grow(std::span<const Planelet> planelets, std::uint32_t seed) {
  const auto number = static_cast<std::uint32_t>(regions_.size());
  Region region{planelets[seed].moments, planelets[seed].fit};
  region_of_planelet_[seed] = number;
  queue_.assign(1, seed);
  for (std::size_t head = 0; head < queue_.size(); ++head) {
    const std::uint32_t from = queue_[head];
    for (std::uint32_t k = first_neighbour_[from]; k < first_neighbour_[from + 1]; ++k) {
      const std::uint32_t to = neighbours_[k];
      if (region_of_planelet_[to] != kNoPatch) continue;
      Region joined;
      if (!coplanar(region, {planelets[to].moments, planelets[to].fit}, joined)) continue;
      region = joined;
      region_of_planelet_[to] = number;
      queue_.push_back(to);
    }
  }
  regions_.push_back(region);
}

// One pass over the pairs of neighbouring regions; false when there was nothing to join.
bool PlaneMerger::join_regions() {
  region_pairs_.clear();
  for (const Pair& pair : pairs_) {
    const std::uint32_t a = region_of_planelet_[pair.a];
    const std::uint32_t b = region_of_planelet_[pair.b];
    if (a != b) region_pairs_.push_back({std::min(a, b), std::max(a, b)});
  }
  std::ranges::sort(region_pairs_);
  region_pairs_.erase(std::unique(region_pairs_.begin(), region_pairs_.end()), region_pairs_.end());
  joined_into_.resize(regions_.size());
  std::iota(joined_into_.begin(), joined_into_.end(), 0U);
  const auto root = [this](std::uint32_t region) {
    while (joined_into_[region] != region) region = joined_into_[region];
    return region;
  };
  bool any = false;
  for (const Pair& pair : region_pairs_) {
    std::uint32_t large = root(pair.a);
    std::uint32_t small = root(pair.b);
    if (large == small) continue;
    if (regions_[large].moments.count() < regions_[small].moments.count()) std::swap(large, small);
    Region joined;
    if (!coplanar(regions_[large], regions_[small], joined)) continue;
    regions_[large] = joined;
    joined_into_[small] = large;
    any = true;
  }
  for (std::uint32_t& region : joined_into_) region = root(region);
  return any;
}

// Leaves no gap where regions were joined.
void PlaneMerger::renumber() {
  queue_.assign(regions_.size(), 0);  // the new numbers
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < regions_.size(); ++i) {
    if (joined_into_[i] != i) continue;
    regions_[count] = regions_[i];
    queue_[i] = count++;
  }
  regions_.resize(count);
  for (std::uint32_t& region : region_of_planelet_) region = queue_[joined_into_[region]];
}

PlaneMerger::Regions PlaneMerger::merge(std::span<const Planelet> planelets) {
  find_neighbours(planelets);
  regions_.clear();
  region_of_planelet_.assign(planelets.size(), kNoPatch);
  by_points_.resize(planelets.size());
  std::iota(by_points_.begin(), by_points_.end(), 0U);
  std::ranges::stable_sort(by_points_, std::ranges::greater{},
                           [&](std::uint32_t i) { return planelets[i].moments.count(); });
  for (const std::uint32_t seed : by_points_) {
    if (region_of_planelet_[seed] == kNoPatch) grow(planelets, seed);
  }
  while (join_regions()) renumber();
  return {regions_, region_of_planelet_};
}

}  // namespace convexcut
