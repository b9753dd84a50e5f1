// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/angle.hpp"
#include "core/time.hpp"
#include "replay/simulation/scene/ray.hpp"
#include "replay/simulation/scene/surface_label.hpp"

namespace convexcut::simulation {

// Bits of SimulatedReturn::flags. The numbers are those of the truth files.
inline constexpr std::uint8_t kIsolatedGhost = 1;  // at a range where nothing is
inline constexpr std::uint8_t kSpecularGhost = 2;  // behind the glass or mirror that is `surface`
inline constexpr std::uint8_t kMixedPixel = 4;     // the beam met surfaces at different ranges
inline constexpr std::uint8_t kThroughGlass = 8;   // a real surface behind glass

// A return and the truth about it.
struct SimulatedReturn {
  std::uint16_t range_2mm = 0;  // as on the wire; 0 = no return, and all else is as made
  float true_range_m = 0.0F;    // without noise and rounding
  SurfaceLabel label = SurfaceLabel::none;  // none: ghosts, and mixed pixels far from any surface
  std::uint8_t flags = 0;
  std::uint16_t surface = kNoSurface;  // index into Scene::surfaces()
  std::uint8_t intensity = 0;
};

// All lasers once, in firing order.
struct SimulatedFiring {
  static constexpr std::size_t kLasers = 32;
  static constexpr std::size_t kMaxEchoes = 2;

  std::uint64_t index = 0;
  Duration since_start{};  // of the first laser, true time
  Azimuth azimuth;         // of the first laser, as on the wire
  // Single return: only the first. Dual: the last echoes, then the strongest, or the second
  // strongest where the last is the strongest; equal where there is but one.
  std::array<std::array<SimulatedReturn, kLasers>, kMaxEchoes> returns{};
};

}  // namespace convexcut::simulation
