// SPDX-License-Identifier: Apache-2.0
#include "core/planes/plane_extractor.hpp"

#include <algorithm>
#include <functional>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace convexcut {
namespace {

const PlaneOptions& checked(const PlaneOptions& options) {
  if (!is_valid(options))
    throw std::invalid_argument("options of the plane extractor out of range");
  return options;
}

// How often points are given to planes and planes fitted to points.
constexpr int kRefinements = 3;

// In units of the noise. What is within 3 σ has 0.99 of it when it is noise, 1.73 when evenly
// spread.
constexpr double kMostRms = 1.3;

[[nodiscard]] PlanePatch patch_of(const PlaneMerger::Region& region) {
  // An evenly filled interval is 2·√3 standard deviations long.
  constexpr double kLengthOfSpread = 2.0 * std::numbers::sqrt3;
  return {.plane = region.fit.plane,
          .centroid = region.moments.mean(),
          .points = static_cast<std::uint32_t>(region.moments.count()),
          .rms_m = region.fit.thickness,
          .length_m = kLengthOfSpread * region.fit.long_spread,
          .width_m = kLengthOfSpread * region.fit.mid_spread};
}

}  // namespace

PlaneExtractor::PlaneExtractor(const PlaneOptions& options)
    : options_(checked(options)),
      tree_(options),
      finder_(options),
      merger_(options),
      membership_(options) {}

PlanePatches PlaneExtractor::extract(const CloudView& cloud) {
  if (cloud.y.size() != cloud.size() || cloud.z.size() != cloud.size() ||
      cloud.size() >= kNoPatch) {
    throw std::invalid_argument("x, y and z of a cloud differ in number, or are too many");
  }
  tree_.build(cloud);
  finder_.find(tree_, planelets_, region_of_point_);
  const PlaneMerger::Regions merged = merger_.merge(planelets_);
  regions_.assign(merged.regions.begin(), merged.regions.end());
  for (std::uint32_t& region : region_of_point_) {
    if (region != kNoPatch) region = merged.region_of_planelet[region];
  }
  support_.assign(regions_.size(), {});
  membership_.begin(tree_);
  for (int round = 0; round < kRefinements; ++round) {
    membership_.assign(tree_, regions_, region_of_point_, support_);
    // The first round only finds out what surely is a sheet.
    if (round > 0) drop_chance_planes();
    refit();
  }
  describe(cloud);
  return {patches_, patch_of_point_};
}

// Their points are free for others in the next round.
void PlaneExtractor::drop_chance_planes() {
  for (std::uint32_t& region : region_of_point_) {
    if (region != kNoPatch && !support_[region].is_sheet()) region = kNoPatch;
  }
}

void PlaneExtractor::refit() {
  if (points_of_region_.size() < regions_.size()) points_of_region_.resize(regions_.size());
  for (PlanePoints& points : points_of_region_) points.clear();
  for (std::size_t i = 0; i < tree_.size(); ++i) {
    if (region_of_point_[i] == kNoPatch) continue;
    points_of_region_[region_of_point_[i]].add(tree_.x()[i], tree_.y()[i], tree_.z()[i]);
  }
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    regions_[i].moments = points_of_region_[i].moments();
    if (regions_[i].moments.count() >= 3) regions_[i].fit = regions_[i].moments.fit();
  }
}

bool PlaneExtractor::is_patch(const PlanePatch& patch) const noexcept {
  return patch.points >= options_.least_patch_points &&
         patch.rms_m <= kMostRms * options_.noise_m &&
         patch.width_m >= options_.least_patch_width_m;
}

// Orders the regions that are patches and translates the points' numbers.
void PlaneExtractor::describe(const CloudView& cloud) {
  order_.resize(regions_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  std::ranges::stable_sort(order_, std::ranges::greater{},
                           [this](std::uint32_t i) { return regions_[i].moments.count(); });
  patches_.clear();
  patch_of_region_.assign(regions_.size(), kNoPatch);
  for (const std::uint32_t i : order_) {
    const PlanePatch patch = patch_of(regions_[i]);
    if (!is_patch(patch)) continue;
    patch_of_region_[i] = static_cast<std::uint32_t>(patches_.size());
    patches_.push_back(patch);
  }
  patch_of_point_.assign(cloud.size(), kNoPatch);
  for (std::uint32_t i = 0; i < tree_.size(); ++i) {
    if (region_of_point_[i] == kNoPatch) continue;
    patch_of_point_[tree_.index(i)] = patch_of_region_[region_of_point_[i]];
  }
}

}  // namespace convexcut
