// SPDX-License-Identifier: Apache-2.0
//
// The rotation of the points of many firings, compiled for every instruction set (Highway, chosen
// when first called). Products and sums are rounded one by one: all paths give the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/cloud.hpp"

namespace convexcut {

// A rotation matrix, row by row.
using Rotation = std::array<float, 9>;

// Points [from, from + count) of one cloud become points [to, to + count) of another.
struct RotatedRun {
  std::size_t from;
  std::size_t to;
  std::size_t count;
  Rotation rotation;
};

struct CloudColumns {
  std::span<float> x;
  std::span<float> y;
  std::span<float> z;
};

// In the order of the runs. What is behind a run's end is undefined until the next run begins
// there: each `to` is the end of the run before it, or behind. RT: no allocation, no lock, no
// system call.
void rotate(std::span<const RotatedRun> runs, const CloudView& from,
            const CloudColumns& to) noexcept;

}  // namespace convexcut
