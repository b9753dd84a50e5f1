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
// keys[begin … end). Whole vectors are written: keys needs kKernelPadding
// elements to spare.
void shell_keys(const CloudView& cloud, std::size_t begin, std::size_t end,
                float inverse_squared_half_width, std::uint16_t* keys) noexcept;

}  // namespace convexcut
