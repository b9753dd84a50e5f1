// SPDX-License-Identifier: Apache-2.0
#include "core/planes/plane_membership.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

namespace convexcut {
namespace {

// A region with this many times the points of another is no clutter beside it.
constexpr std::uint32_t kMuchLarger = 4;

}  // namespace

PlaneMembership::PlaneMembership(const PlaneOptions& options)
    : level_(std::min(options.levels, 1U)), reach_(static_cast<float>(3.0 * options.noise_m)) {}

void PlaneMembership::list_regions(const CellTree& tree,
                                   const Workspace<std::uint32_t>& region_of_point) {
  cells_.clear();
  regions_.clear();
  const CellTree::Range all = tree.all();
  for (std::uint32_t at = all.begin; at < all.end;) {
    const CellTree::Range points = tree.cell_at(at, all.end, level_);
    const auto first = static_cast<std::uint32_t>(regions_.size());
    cells_.push_back({tree.key(at, level_), points, first});
    std::uint32_t newest = kNoPatch;  // neighbours are mostly of one region
    for (std::uint32_t i = points.begin; i < points.end; ++i) {
      if (region_of_point[i] == kNoPatch || region_of_point[i] == newest || shared_[i] != 0)
        continue;
      newest = region_of_point[i];
      regions_.push_back(newest);
    }
    const auto begin = regions_.begin() + first;
    std::sort(begin, regions_.end());
    regions_.erase(std::unique(begin, regions_.end()), regions_.end());
    at = points.end;
  }
  cells_.push_back(
      {std::numeric_limits<std::uint64_t>::max(), {}, static_cast<std::uint32_t>(regions_.size())});
}

void PlaneMembership::gather_candidates(std::size_t cell,
                                        std::span<const PlaneMerger::Region> regions,
                                        std::span<const Support> support) {
  near_regions_.clear();
  const CellTree::Cell centre = CellTree::cell_of(cells_[cell].key);
  for (std::uint32_t k = 0; k < 27; ++k) {
    // 0 … 2 stands for one below … one above. No cell is below 0.
    const std::uint32_t dx = k % 3, dy = k / 3 % 3, dz = k / 9;
    if (centre.x + dx == 0 || centre.y + dy == 0 || centre.z + dz == 0) continue;
    const std::uint64_t key =
        CellTree::key_of({centre.x + dx - 1, centre.y + dy - 1, centre.z + dz - 1});
    const auto found = std::ranges::lower_bound(cells_, key, {}, &Cell::key);
    if (found->key != key) continue;
    near_regions_.insert(near_regions_.end(), regions_.begin() + found->first_region,
                         regions_.begin() + std::next(found)->first_region);
  }
  std::ranges::sort(near_regions_);
  const auto [repeated, end] = std::ranges::unique(near_regions_);
  near_regions_.erase(repeated, end);

  candidates_.clear();
  const auto here_begin = regions_.begin() + cells_[cell].first_region;
  const auto here_end = regions_.begin() + cells_[cell + 1].first_region;
  for (const std::uint32_t region : near_regions_) {
    candidates_.push_back({region, FloatPlane(regions[region].fit.plane),
                           static_cast<std::uint32_t>(regions[region].moments.count()),
                           support[region].sure, std::binary_search(here_begin, here_end, region)});
  }
  std::ranges::stable_sort(candidates_, std::ranges::greater{}, &Candidate::points);
  distances_.resize(candidates_.size());
}

PlaneMembership::Verdict PlaneMembership::judge(float x, float y, float z,
                                                std::vector<Support>& support) {
  const std::size_t count = candidates_.size();
  std::size_t nearest = count;
  float least = reach_;
  for (std::size_t k = 0; k < count; ++k) {
    distances_[k] = std::abs(candidates_[k].plane.signed_distance_m(x, y, z));
    if (distances_[k] > least) continue;
    least = distances_[k];
    nearest = k;
  }
  const bool of_sure_sheet = nearest < count && candidates_[nearest].sure;
  const std::uint32_t own_points = nearest < count ? candidates_[nearest].points : 0;
  for (std::size_t k = 0; k < count && !of_sure_sheet; ++k) {
    const Candidate& candidate = candidates_[k];
    if (!candidate.here || distances_[k] <= reach_ || distances_[k] > 2.0F * reach_) continue;
    if (own_points < kMuchLarger * candidate.points) ++support[candidate.region].outside;
  }
  if (nearest == count) return {kNoPatch, false};
  // Those before it have more points.
  const bool shared =
      std::any_of(distances_.begin(), distances_.begin() + static_cast<std::ptrdiff_t>(nearest),
                  [this](float d) { return d <= reach_; });
  Support& own = support[candidates_[nearest].region];
  ++own.points;
  own.shared += shared ? 1U : 0U;
  return {candidates_[nearest].region, shared};
}

void PlaneMembership::assign(const CellTree& tree, std::span<const PlaneMerger::Region> regions,
                             Workspace<std::uint32_t>& region_of_point,
                             std::vector<Support>& support) {
  list_regions(tree, region_of_point);
  for (Support& of_region : support) of_region = {.sure = of_region.is_surely_sheet()};
  for (std::size_t cell = 0; cell + 1 < cells_.size(); ++cell) {
    gather_candidates(cell, regions, support);
    const CellTree::Range points = cells_[cell].points;
    for (std::uint32_t i = points.begin; i < points.end; ++i) {
      const Verdict verdict = judge(tree.x()[i], tree.y()[i], tree.z()[i], support);
      region_of_point[i] = verdict.region;
      shared_[i] = verdict.shared ? 1 : 0;
    }
  }
}

}  // namespace convexcut
