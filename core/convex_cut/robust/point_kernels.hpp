// SPDX-License-Identifier: Apache-2.0
//
// The loops over the points of a revolution, compiled for every instruction set (core/simd). All
// give the same bits: no fused multiply-add, and sums in one order. RT: no allocation, no lock, no
// system call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/cloud.hpp"
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

}  // namespace convexcut::robust
