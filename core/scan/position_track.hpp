// SPDX-License-Identifier: Apache-2.0
//
// The way of the lidar, to be asked for its place at any instant.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "core/pose_sample.hpp"

namespace convexcut {

// Immutable: any number of threads may ask.
class PositionTrack {
 public:
  // Between two poses that are further apart than this nothing is known.
  static constexpr Duration kLargestGap = std::chrono::seconds{1};

  // Throws std::invalid_argument when stamps do not ascend.
  explicit PositionTrack(std::vector<PoseSample> poses);

  // On the straight line between the neighbours; none before the first pose, behind the last one,
  // or in a gap. RT: no allocation, no lock, no system call.
  [[nodiscard]] std::optional<Vec3> at(HostTime time) const noexcept;

  [[nodiscard]] const std::vector<PoseSample>& poses() const noexcept { return poses_; }

 private:
  std::vector<PoseSample> poses_;
};

}  // namespace convexcut
