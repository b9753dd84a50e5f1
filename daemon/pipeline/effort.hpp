// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut::daemon {

// How much is computed for a scan, in the order in which it is reduced when time is short. Fewer
// planes come first: every point keeps its place and label, only structure seen by the left-out
// planes alone is missed. Fewer points come last. The robust method has no slicing planes: it
// learns from fewer revolutions, and labels that waited for that no longer do.
enum class Effort : std::uint8_t {
  full,
  half_planes,     // every second slicing plane; robust: every second revolution is learnt from
  quarter_planes,  // every fourth
  half_points,     // every fourth plane or revolution, every second firing
};

inline constexpr Effort kLeastEffort = Effort::half_points;

[[nodiscard]] constexpr std::uint32_t plane_stride(Effort effort) noexcept {
  if (effort == Effort::full) return 1;
  return effort == Effort::half_planes ? 2 : 4;
}
// Revolutions for one that is learnt from.
[[nodiscard]] constexpr std::uint32_t learning_stride(Effort effort) noexcept {
  return plane_stride(effort);
}
[[nodiscard]] constexpr std::uint32_t firing_stride(Effort effort) noexcept {
  return effort == Effort::half_points ? 2 : 1;
}

}  // namespace convexcut::daemon
