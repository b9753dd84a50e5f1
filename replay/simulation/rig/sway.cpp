// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/rig/sway.hpp"

#include <cmath>
#include <numbers>

#include "replay/simulation/sin_cos.hpp"

namespace convexcut::simulation {
namespace {

// A sine of its own band each: 0.2 … 0.34 … 0.59 … 1 … 1.75 … 3 Hz.
constexpr double kLowestHz = 0.2;
constexpr double kBandRatio = 1.72;

}  // namespace

Sway::Sway(double root_mean_square, Random& random) : still_(root_mean_square == 0.0) {
  double band_hz = kLowestHz;
  double squares = 0.0;
  for (Sine& sine : sines_) {
    const double hz = random.uniform(band_hz, band_hz * kBandRatio);
    sine = {.amplitude = 1.0 / hz,
            .omega = 2.0 * std::numbers::pi * hz,
            .phase = 2.0 * std::numbers::pi * random.uniform()};
    squares += sine.amplitude * sine.amplitude / 2.0;
    band_hz *= kBandRatio;
  }
  for (Sine& sine : sines_) sine.amplitude *= root_mean_square / std::sqrt(squares);
}

Sway::Motion Sway::at(Duration since_start) const noexcept {
  Motion sum;
  if (still_) return sum;
  const double t = std::chrono::duration<double>(since_start).count();
  for (const auto& [amplitude, omega, phase] : sines_) {
    const auto [sine, cosine] = sin_cos(Radians{omega * t + phase});
    sum.value += amplitude * sine;
    sum.rate += amplitude * omega * cosine;
    sum.acceleration -= amplitude * omega * omega * sine;
  }
  return sum;
}

std::array<Sway, 3> three_sways(double root_mean_square, Random random) {
  Sway first(root_mean_square, random);
  Sway second(root_mean_square, random);
  Sway third(root_mean_square, random);
  return {first, second, third};
}

}  // namespace convexcut::simulation
