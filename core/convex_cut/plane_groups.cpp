// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/plane_groups.hpp"

#include <algorithm>
#include <bit>

namespace convexcut {

PlaneGroups::PlaneGroups(std::uint32_t planes)
    : count_(std::min(planes, kMostGroups)), reach_(ShellIndex::kShells * ShellIndex::kBuckets) {
  constexpr std::size_t kBuckets = ShellIndex::kBuckets;
  for (std::uint32_t i = 0; i < planes; ++i) {
    planes_.push_back(slicing_plane(i, planes));
    windows_.push_back(ShellIndex::windows(planes_.back()));
  }
  for (std::uint32_t group = 0; group < count_; ++group) {
    const std::uint32_t bit = std::uint32_t{1} << group;
    // Shell 0 is on the axis: its points are candidates of every plane.
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) reach_[bucket].any |= bit;
    for (std::uint32_t i = begin(group); i < end(group); ++i) {
      for (std::size_t shell = 1; shell < ShellIndex::kShells; ++shell) {
        const ShellIndex::Window window = windows_[i][shell];
        for (std::size_t k = 0; k < window.count; ++k) {
          const std::size_t bucket = window.first + k;
          Reach& ahead = reach_[shell * kBuckets + bucket % kBuckets];
          Reach& behind = reach_[shell * kBuckets + (bucket + kBuckets / 2) % kBuckets];
          ahead.ahead |= bit;
          ahead.any |= bit;
          behind.behind |= bit;
          behind.any |= bit;
        }
      }
    }
  }
  for (Reach& reach : reach_) reach.is_far = std::popcount(reach.any) <= kMostGroupsOfFar;
}

std::uint32_t PlaneGroups::begin(std::uint32_t group) const noexcept {
  return static_cast<std::uint32_t>(std::uint64_t{group} * planes_.size() / count_);
}

}  // namespace convexcut
