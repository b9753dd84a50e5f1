// SPDX-License-Identifier: Apache-2.0
//
// The loops over the points of a revolution, compiled for every instruction set (core/simd). All
// give the same bits: no fused multiply-add, and sums in one order. RT: no allocation, no lock, no
// system call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/cloud.hpp"
#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/pose.hpp"

namespace convexcut::robust {

// So many points are taken at once.
inline constexpr std::size_t kPointsAtOnce = 256;

// Where points lie on the lattice of voxels, and how far off their voxels' centres.
struct PlacedPoints {
  alignas(64) std::array<std::int32_t, kPointsAtOnce> x, y, z;  // see Lattice
  alignas(64) std::array<std::int32_t, kPointsAtOnce> x_mm, y_mm, z_mm;
};

// Points [begin, begin + kPointsAtOnce) of a cloud, or as many as there are, by RigPose::apply.
// What of `placed` is behind the last is undefined.
void place_points(const CloudView& cloud, std::size_t begin, const RigPose& pose,
                  PlacedPoints& placed) noexcept;

// Points of a revolution, and when: their share of its time less a half (RigPose::apply). Whole
// vectors are read: as many more elements as kPointsAtOnce follow the last.
struct TimedPoints {
  const float* x;
  const float* y;
  const float* z;
  const float* from_middle;
};

// The same in the window's frame; and as bits, lowest first, the accepted planes that they are
// near.
struct PointsOnPlanes {
  alignas(64) std::array<float, kPointsAtOnce> x, y, z;
  alignas(64) std::array<std::uint32_t, kPointsAtOnce> low, high;  // planes 0 … 31, 32 … 63

  [[nodiscard]] std::uint64_t planes(std::size_t i) const noexcept {
    return (static_cast<std::uint64_t>(high[i]) << 32U) | low[i];
  }
};

// Points [begin, begin + kPointsAtOnce): near is nearer than gate_m. At most 64 planes.
void find_planes(const TimedPoints& points, std::size_t begin, const RigPose& pose,
                 std::span<const Plane> planes, float gate_m, PointsOnPlanes& found) noexcept;

}  // namespace convexcut::robust
