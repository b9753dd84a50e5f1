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

// Columns of points. Whole vectors are read: as many more elements as kPointsAtOnce follow the
// last.
struct PointColumns {
  const float* x;
  const float* y;
  const float* z;
};

struct MovedPoints {
  alignas(64) std::array<float, kPointsAtOnce> x, y, z;
  [[nodiscard]] PointColumns columns() const noexcept { return {x.data(), y.data(), z.data()}; }
};
// By RigPose::apply; from_middle: each point's share of the revolution's time, less a half.
void move_points(const PointColumns& points, const float* from_middle, const RigPose& pose,
                 MovedPoints& moved) noexcept;
// The points that place_points() places.
void move_points(const CloudView& cloud, std::size_t begin, const RigPose& pose,
                 MovedPoints& moved) noexcept;

// Sets of planes, as bits, the first plane lowest.
class PlaneSets {
 public:
  [[nodiscard]] std::uint64_t operator[](std::size_t i) const noexcept {
    return (static_cast<std::uint64_t>(high[i]) << 32U) | low[i];
  }
  alignas(64) std::array<std::uint32_t, kPointsAtOnce> low, high;  // planes 0 … 31, 32 … 63
};

// Of at most 64.
[[nodiscard]] std::uint64_t accepted_planes(std::span<const Plane> planes) noexcept;

// Of kPointsAtOnce points each, the planes of the set `asked` that are at most gate_m away. At most
// 64 planes.
void find_planes(const PointColumns& points, std::span<const Plane> planes, std::uint64_t asked,
                 float gate_m, PlaneSets& found) noexcept;

}  // namespace convexcut::robust
