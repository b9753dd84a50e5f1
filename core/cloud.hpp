// SPDX-License-Identifier: Apache-2.0
//
// A cloud as Convex Cut sees it: coordinates as a structure of arrays, one label a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace convexcut {

// Frame level, metres. The three spans are equally long.
struct CloudView {
  std::span<const float> x;
  std::span<const float> y;
  std::span<const float> z;
  [[nodiscard]] std::size_t size() const noexcept { return x.size(); }
};

enum class Label : std::uint8_t { other = 0, structure = 1 };

}  // namespace convexcut
