// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/time.hpp"
#include "replay/simulation/random.hpp"

namespace convexcut::simulation {

// One coordinate of a hand that tries to hold still: a sum of sines whose frequencies are spread
// over 0.2 … 3 Hz, with amplitudes that fall with the frequency, as of a hand that is slow. Exact
// derivatives; the same for the same random numbers.
class Sway {
 public:
  struct Motion {
    double value = 0.0;  // in the unit of the root mean square
    double rate = 0.0;   // 1/s
    double acceleration = 0.0;
  };

  Sway(double root_mean_square, Random& random);

  [[nodiscard]] Motion at(Duration since_start) const noexcept;

 private:
  static constexpr std::size_t kSines = 5;

  struct Sine {
    double amplitude = 0.0;
    double omega = 0.0;  // rad/s
    double phase = 0.0;
  };
  std::array<Sine, kSines> sines_{};
  bool still_;
};

// Of three coordinates that have nothing to do with each other.
[[nodiscard]] std::array<Sway, 3> three_sways(double root_mean_square, Random random);

}  // namespace convexcut::simulation
