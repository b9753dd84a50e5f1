// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/azimuth_steps.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace convexcut::velodyne {
namespace {

constexpr std::int32_t kFullTurn = 36000;

// The shorter way round: −17999 … 18000.
std::int32_t signed_difference(std::int32_t to, std::int32_t from) noexcept {
  const std::int32_t clockwise = (to - from + kFullTurn) % kFullTurn;
  return clockwise > kFullTurn / 2 ? clockwise - kFullTurn : clockwise;
}

// Recordings show ±2 of encoder rounding at any speed; a quarter more leaves room for a rotor that
// speeds up.
constexpr std::int32_t kLeastGlitch = 5;
bool is_glitch(std::int32_t step, std::int32_t median) noexcept {
  return std::abs(step - median) > kLeastGlitch + std::abs(median) / 4;
}

}  // namespace

AzimuthSteps azimuth_steps(std::span<const std::uint16_t> azimuths,
                           std::int32_t max_step) noexcept {
  assert(azimuths.size() >= 2 && azimuths.size() <= wire_layout::kBlocks);
  AzimuthSteps steps{};
  const std::size_t differences = azimuths.size() - 1;
  for (std::size_t i = 0; i < differences; ++i) {
    steps[i] = signed_difference(azimuths[i + 1], azimuths[i]);
  }
  steps[differences] = steps[differences - 1];
  const auto all = std::span(steps).first(differences);
  const auto [least, most] = std::ranges::minmax(all);
  // So near to each other that none can be a glitch, whatever the median.
  const bool alike = most - least <= kLeastGlitch;
  if (alike && most <= max_step && least >= -max_step) return steps;

  AzimuthSteps sorted = steps;
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(differences));
  const std::int32_t median = sorted[differences / 2];
  if (std::abs(median) > max_step) return {};
  for (std::size_t i = 0; i < differences; ++i) {
    if (is_glitch(steps[i], median)) steps[i] = median;
  }
  steps[differences] = steps[differences - 1];
  return steps;
}

}  // namespace convexcut::velodyne
