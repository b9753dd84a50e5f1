// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/slice_kernels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace convexcut {
namespace {

// The axes on which extremes are looked for; each gives a least and a greatest point. Those that
// lean a little from u and z find the outermost noise at both ends of walls, floor and ceiling: the
// polygon then hugs them, and few points are left outside of it.
constexpr std::size_t kAxes = kExtremes / 2;
[[nodiscard]] std::array<float, kAxes> on_axes(float u, float z) noexcept {
  constexpr float kLean = 1.0F / 16.0F;
  return {u, u + kLean * z, u + z, z + kLean * u, z, z - kLean * u, z - u, kLean * z - u};
}

// An index takes the place of a value's lowest mantissa bits, so that one maximum finds both.
constexpr std::uint32_t kIndexBits = 11;
constexpr std::uint32_t kIndexMask = (1U << kIndexBits) - 1U;

[[nodiscard]] float with_index(float value, std::uint32_t index) noexcept {
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(value) & ~kIndexMask) | index);
}
[[nodiscard]] std::size_t index_in(float tagged) noexcept {
  return std::bit_cast<std::uint32_t>(tagged) & kIndexMask;
}

struct AxisExtremes {
  std::array<float, kAxes> least;
  std::array<float, kAxes> greatest;
};

// The tagged extremes of all points; index = number of the point's group of 2^group_bits.
[[nodiscard]] AxisExtremes tagged_extremes(const SliceColumns& members, std::size_t count,
                                           std::uint32_t group_bits) noexcept {
  constexpr std::size_t kLanes = 8;
  constexpr float kMost = std::numeric_limits<float>::max();
  std::array<std::array<float, kLanes>, kAxes> least;
  std::array<std::array<float, kLanes>, kAxes> greatest;
  for (auto& lanes : least) lanes.fill(kMost);
  for (auto& lanes : greatest) lanes.fill(-kMost);
  for (std::size_t base = 0; base < count; base += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto group = static_cast<std::uint32_t>(base + lane) >> group_bits;
      const auto values = on_axes(members.u[base + lane], members.z[base + lane]);
      for (std::size_t axis = 0; axis < kAxes; ++axis) {
        const float value = with_index(values[axis], group);
        least[axis][lane] = value < least[axis][lane] ? value : least[axis][lane];
        greatest[axis][lane] = value > greatest[axis][lane] ? value : greatest[axis][lane];
      }
    }
  }
  AxisExtremes result;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    result.least[axis] = *std::ranges::min_element(least[axis]);
    result.greatest[axis] = *std::ranges::max_element(greatest[axis]);
  }
  return result;
}

// The point of a group that is outermost on an axis, in direction `sign`.
[[nodiscard]] std::size_t outermost(const SliceColumns& members, std::size_t begin, std::size_t end,
                                    std::size_t axis, float sign) noexcept {
  std::size_t best = begin;
  float best_value = -std::numeric_limits<float>::max();
  for (std::size_t i = begin; i < end; ++i) {
    const float value = sign * on_axes(members.u[i], members.z[i])[axis];
    if (value > best_value) {
      best = i;
      best_value = value;
    }
  }
  return best;
}

}  // namespace

std::size_t gather(const CloudView& sorted, ShellIndex::Range range, const SlicingPlane& plane,
                   double half_width_m, const SliceColumns& members, std::size_t count) noexcept {
  constexpr std::size_t kChunk = 64;
  std::array<double, kChunk> offset;
  std::array<float, kChunk> along;
  const SlicingPlane local = plane;
  for (std::size_t begin = range.begin; begin < range.end; begin += kChunk) {
    const std::size_t length = std::min<std::size_t>(kChunk, range.end - begin);
    const float* const x = sorted.x.data() + begin;
    const float* const y = sorted.y.data() + begin;
    const float* const z = sorted.z.data() + begin;
    for (std::size_t i = 0; i < length; ++i) {
      offset[i] = local.offset(x[i], y[i]);
      along[i] = static_cast<float>(local.along(x[i], y[i]));
    }
    for (std::size_t i = 0; i < length; ++i) {
      // Written in any case and kept if it counts: whether it does cannot be predicted.
      members.u[count] = along[i];
      members.z[count] = z[i];
      members.position[count] = static_cast<std::uint32_t>(begin + i);
      count += static_cast<std::size_t>(std::abs(offset[i]) < half_width_m);
    }
  }
  return count;
}

std::array<std::size_t, kExtremes> extremes(const SliceColumns& members,
                                            std::size_t count) noexcept {
  // Whole blocks of lanes: the rest repeats the last point.
  for (std::size_t i = count; i % kKernelBlock != 0; ++i) {
    members.u[i] = members.u[count - 1];
    members.z[i] = members.z[count - 1];
  }
  std::uint32_t group_bits = 0;
  while ((count >> group_bits) > kIndexMask) ++group_bits;

  const AxisExtremes tagged = tagged_extremes(members, count, group_bits);
  std::array<std::size_t, kExtremes> found;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const auto resolve = [&](float tag, float sign) {
      const std::size_t begin = std::min(index_in(tag) << group_bits, count - 1);
      const std::size_t end = std::min(begin + (std::size_t{1} << group_bits), count);
      return outermost(members, begin, end, axis, sign);
    };
    found[axis] = resolve(tagged.greatest[axis], 1.0F);
    found[axis + kAxes] = resolve(tagged.least[axis], -1.0F);
  }
  return found;
}

void depth_within(const EdgeColumns& edges, std::size_t edge_count, const SliceColumns& points,
                  std::size_t count, float* depth) noexcept {
  for (std::size_t base = 0; base < count; base += kKernelBlock) {
    const float* const u = points.u + base;
    const float* const z = points.z + base;
    std::array<float, kKernelBlock> nearest;
    nearest.fill(std::numeric_limits<float>::max());
    for (std::size_t k = 0; k < edge_count; ++k) {
      const float normal_u = edges.normal_u[k];
      const float normal_z = edges.normal_z[k];
      const float offset = edges.offset[k];
      for (std::size_t i = 0; i < kKernelBlock; ++i) {
        const float distance = normal_u * u[i] + normal_z * z[i] - offset;
        nearest[i] = distance < nearest[i] ? distance : nearest[i];
      }
    }
    std::ranges::copy(nearest, depth + base);
  }
}

}  // namespace convexcut
