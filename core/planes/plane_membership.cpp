// SPDX-License-Identifier: Apache-2.0
#include "core/planes/plane_membership.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace convexcut {

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
      if (region_of_point[i] == kNoPatch || region_of_point[i] == newest) continue;
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

void PlaneMembership::gather_candidates(std::size_t cell) {
  candidates_.clear();
  const CellTree::Cell centre = CellTree::cell_of(cells_[cell].key);
  for (std::uint32_t k = 0; k < 27; ++k) {
    // 0 … 2 stands for one below … one above. No cell is below 0.
    const std::uint32_t dx = k % 3, dy = k / 3 % 3, dz = k / 9;
    if (centre.x + dx == 0 || centre.y + dy == 0 || centre.z + dz == 0) continue;
    const std::uint64_t key =
        CellTree::key_of({centre.x + dx - 1, centre.y + dy - 1, centre.z + dz - 1});
    const auto found = std::ranges::lower_bound(cells_, key, {}, &Cell::key);
    if (found->key != key) continue;
    const auto next = found + 1;
    candidates_.insert(candidates_.end(), regions_.begin() + found->first_region,
                       regions_.begin() + next->first_region);
  }
  std::ranges::sort(candidates_);
  const auto [repeated, end] = std::ranges::unique(candidates_);
  candidates_.erase(repeated, end);
}

void PlaneMembership::assign(const CellTree& tree, std::span<const PlaneMerger::Region> regions,
                             Workspace<std::uint32_t>& region_of_point) {
  list_regions(tree, region_of_point);
  for (std::size_t cell = 0; cell + 1 < cells_.size(); ++cell) {
    gather_candidates(cell);
    const CellTree::Range points = cells_[cell].points;
    for (std::uint32_t i = points.begin; i < points.end; ++i) {
      float least = reach_;
      region_of_point[i] = kNoPatch;
      for (const std::uint32_t candidate : candidates_) {
        const FloatPlane plane(regions[candidate].fit.plane);
        const float d = std::abs(plane.signed_distance_m(tree.x()[i], tree.y()[i], tree.z()[i]));
        if (d > least) continue;
        least = d;
        region_of_point[i] = candidate;
      }
    }
  }
}

}  // namespace convexcut
