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
// keys[begin … end). Returns the least and the greatest of them. Needs begin < end.
struct KeyBounds {
  std::uint16_t least = 0xFFFF;
  std::uint16_t greatest = 0;
};
KeyBounds shell_keys(const CloudView& cloud, std::size_t begin, std::size_t end,
                     float inverse_squared_half_width, std::uint16_t* keys) noexcept;

// A point on its way to its place: four words, for one store.
struct alignas(16) PointRecord {
  float x, y, z;
  std::uint32_t source;  // its index in the cloud
};

// Points [begin, end) of a cloud with their keys, and where the next point of each key goes.
struct KeyedPart {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::uint32_t* next = nullptr;
};

// Puts the points of two parts of a cloud to their places, in turn: points that follow each other
// often have the same key, and would wait for each other's place.
void place_points(const CloudView& cloud, const std::uint16_t* keys, const KeyedPart& a,
                  const KeyedPart& b, PointRecord* records) noexcept;

// Sorted points.
struct PointColumns {
  float* x;
  float* y;
  float* z;
  std::uint32_t* source;
};
// Copies records [begin, end) to the same places of the columns. Whole vectors are read and
// written.
void spread_records(const PointRecord* records, std::size_t begin, std::size_t end,
                    const PointColumns& columns) noexcept;

}  // namespace convexcut
