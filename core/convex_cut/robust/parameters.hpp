// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut {

// Of RobustCut. Each part can be left out, to measure what it is worth.
struct RobustParameters {
  // Revolutions that decide together, the newest included: half a turn of a stage that turns by 60°
  // a second. Ten take two thirds of the time in a hall (docs/design/robust.md).
  std::uint32_t window = 30;
  // A point is structure when it is at most this far before a surface that was accepted, and at
  // most 8 cm, or this, behind it.
  float band_m = 0.055F;

  bool upright = true;     // corrects the direction of gravity by floor and walls
  bool align = true;       // corrects each revolution's pose by the planes known so far
  bool furniture = true;   // a front with a wall close behind it is furniture
  bool fixtures = true;    // what is mounted flat on a wall is no wall
  bool mirrors = true;     // what is a wall's mirror image is none
  bool curved = true;      // what goes on smoothly from a wall is one
  bool steady = true;      // what was decided in earlier revolutions has a say
  bool pillars = true;     // compact tall footprints are structure
  bool free_space = true;  // a surface must bound the free space; without, all planes are kept
};

inline constexpr std::uint32_t kMaxRobustWindow = 100;

// False for NaN as well.
[[nodiscard]] constexpr bool is_valid(const RobustParameters& p) noexcept {
  return p.window >= 1 && p.window <= kMaxRobustWindow && p.band_m > 0.0F && p.band_m <= 0.2F;
}

}  // namespace convexcut
