// SPDX-License-Identifier: Apache-2.0
//
// The three parameters of Convex Cut (Jun, Youn, Choi, Medioni, Doh: "Convex Cut: A Realtime
// Pseudo-Structure Extraction Algorithm for 3D Point Cloud Data"), and what a call may answer.
#pragma once

#include <cstdint>

namespace convexcut {

struct ConvexCutParameters {
  // n: slicing planes θᵢ = π·i/n through the z axis.
  std::uint32_t planes = 360;
  // d: a point belongs to a slice when it is closer than this to the slice's plane.
  double half_width_m = 0.05;
  // e: a point is structure when it is at most this far from the boundary of its slice's hull. It
  // has to cover the sensor's noise: the hull rides on the outermost returns.
  double hull_distance_m = 0.08;
};

inline constexpr std::uint32_t kMaxPlanes = 36'000;
inline constexpr double kMinHalfWidthM = 1e-6;
inline constexpr double kMaxWidthM = 1e3;

// False for NaN as well.
[[nodiscard]] constexpr bool is_valid(const ConvexCutParameters& p) noexcept {
  return p.planes >= 1 && p.planes <= kMaxPlanes &&  //
         p.half_width_m >= kMinHalfWidthM && p.half_width_m <= kMaxWidthM &&
         p.hull_distance_m >= 0.0 && p.hull_distance_m <= kMaxWidthM;
}

// Coordinates beyond this are no measurement. The bound lets float distances be trusted to a known
// error (see slice_worker.hpp).
inline constexpr float kMaxCoordinateM = 1e6F;

// On anything but `ok` no label has been written.
enum class CutStatus : std::uint8_t {
  ok = 0,
  too_many_points,          // more than the engine was built for
  size_mismatch,            // x, y, z and the labels are not equally long
  coordinate_out_of_range,  // NaN, infinite or beyond kMaxCoordinateM
};

}  // namespace convexcut
