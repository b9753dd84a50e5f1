// SPDX-License-Identifier: Apache-2.0
//
// The loops over all points of a cloud, compiled for every instruction set as those in
// slice_kernels.hpp. RT: no allocation, no lock, no system call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/cloud.hpp"

namespace convexcut {

// The kernels load and store whole vectors: every column, and the columns of the sorted points,
// can be read and written this many elements past their end.
inline constexpr std::size_t kKernelPadding = 64;

// The bit pattern of the greatest magnitude. The patterns of magnitudes are ordered as the
// magnitudes are, with infinity and the NaNs above all numbers; unlike a float maximum, an integer
// one loses no NaN.
[[nodiscard]] std::uint32_t greatest_magnitude_bits(std::span<const float> values) noexcept;

// The keys that ShellIndex sorts by, shell · kBuckets + bucket, of points [begin, end) into
// keys[begin … end). Returns the least and the greatest of them, and the points'
// greatest_magnitude_bits: where these are not of a number, keys mean nothing. Needs begin < end.
struct KeyBounds {
  std::uint16_t least = 0xFFFF;
  std::uint16_t greatest = 0;
  std::uint32_t magnitude_bits = 0;
};
KeyBounds shell_keys(const CloudView& cloud, std::size_t begin, std::size_t end,
                     float inverse_squared_half_width, std::uint16_t* keys) noexcept;

// A point on its way to its place: four words, for one store.
struct alignas(16) PointRecord {
  float x, y, z;
  std::uint32_t source;  // its index in the cloud
};

// Puts points [begin, end) of a cloud to their places: starts[key] is where the first one of each
// key goes, and ranks[i] how many of point i's key go before it.
void place_points(const CloudView& cloud, const std::uint16_t* keys, const std::uint32_t* ranks,
                  std::size_t begin, std::size_t end, const std::uint32_t* starts,
                  PointRecord* records) noexcept;

// Sorted points.
struct PointColumns {
  float* x;
  float* y;
  float* z;
  std::uint32_t* source;
};
// Copies records [begin, end) to the same places of the columns, which begin at a cache line, as
// does `begin`. Whole vectors are read and written; past_the_cache: into memory, where the columns
// are larger than the caches.
void spread_records(const PointRecord* records, std::size_t begin, std::size_t end,
                    const PointColumns& columns, bool past_the_cache) noexcept;

}  // namespace convexcut
