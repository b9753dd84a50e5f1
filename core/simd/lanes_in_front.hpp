// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace convexcut {

// kLanesInFront[mask]: the lanes of an eight-lane mask in turn, then lane 0: a permutation that
// moves the chosen lanes to the front.
using LaneOrder = std::array<std::uint32_t, 8>;
[[nodiscard]] constexpr std::array<LaneOrder, 256> lanes_in_front() noexcept {
  std::array<LaneOrder, 256> table{};
  for (std::size_t mask = 0; mask < table.size(); ++mask) {
    std::size_t next = 0;
    for (std::uint32_t lane = 0; lane < 8; ++lane) {
      if (((mask >> lane) & 1U) != 0) table[mask][next++] = lane;
    }
  }
  return table;
}
alignas(64) inline constexpr std::array<LaneOrder, 256> kLanesInFront = lanes_in_front();

}  // namespace convexcut
