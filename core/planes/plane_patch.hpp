// SPDX-License-Identifier: Apache-2.0
//
// Plane patches: connected flat pieces of a cloud.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "core/geometry.hpp"

namespace convexcut {

// The points p of the plane: normal · p = offset. Frame and origin are the cloud's; metres.
struct Plane {
  Vec3 normal = Vec3::UnitZ();  // of length 1; offset_m ≥ 0, so it points away from the origin
  double offset_m = 0.0;

  [[nodiscard]] double signed_distance_m(const Vec3& p) const { return normal.dot(p) - offset_m; }
};

struct PlanePatch {
  Plane plane;
  Vec3 centroid = Vec3::Zero();
  std::uint32_t points = 0;
  double rms_m = 0.0;     // of the points' distances from the plane
  double length_m = 0.0;  // spread along its longest direction: 2·√3 standard deviations, which of
  double width_m = 0.0;  // an evenly covered rectangle are its sides
};

// Of a point that is in no patch.
inline constexpr std::uint32_t kNoPatch = std::numeric_limits<std::uint32_t>::max();

// What an extraction gave; valid until the extractor's next one.
struct PlanePatches {
  std::span<const PlanePatch> patches;            // by number of points, most first
  std::span<const std::uint32_t> patch_of_point;  // index into patches, or kNoPatch
};

}  // namespace convexcut
