// SPDX-License-Identifier: Apache-2.0
#include "core/scan/position_track.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>

namespace convexcut {

PositionTrack::PositionTrack(std::vector<PoseSample> poses) : poses_(std::move(poses)) {
  const auto not_later =
      std::ranges::adjacent_find(poses_, std::ranges::greater_equal{}, &PoseSample::stamp);
  if (not_later != poses_.end()) throw std::invalid_argument("stamps of poses do not ascend");
}

std::optional<Vec3> PositionTrack::at(HostTime time) const noexcept {
  const auto after = std::ranges::lower_bound(poses_, time, {}, &PoseSample::stamp);
  if (after == poses_.end()) return std::nullopt;
  if (after->stamp == time) return after->position_world;
  if (after == poses_.begin()) return std::nullopt;
  const PoseSample& before = *(after - 1);
  const Duration gap = after->stamp - before.stamp;
  if (gap > kLargestGap) return std::nullopt;
  const double share =
      static_cast<double>((time - before.stamp).count()) / static_cast<double>(gap.count());
  return before.position_world + share * (after->position_world - before.position_world);
}

}  // namespace convexcut
