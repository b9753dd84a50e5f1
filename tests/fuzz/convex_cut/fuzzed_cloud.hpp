// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as parameters and a cloud for Convex Cut, of the kinds that are hard for it: points on
// a line, in one place, on the border of a slice, at the hull distance, on a circle, in a lattice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/convex_cut/parameters.hpp"
#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut::test {

inline constexpr std::size_t kMaxFuzzedPoints = 1200;

struct FuzzedCloud {
  ConvexCutParameters parameters;
  std::uint32_t plane_stride = 1;
  Cloud cloud;
};

// Points further away than the engine takes are left out.
[[nodiscard]] FuzzedCloud fuzzed_cloud(std::span<const std::uint8_t> bytes);

// The first instruction set and number of threads with which the engine's labels are not the
// reference's; empty when there is none.
[[nodiscard]] std::string_view differing_path(const FuzzedCloud& input);

}  // namespace convexcut::test
