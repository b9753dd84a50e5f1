// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

namespace convexcut::sim {

// Random numbers that are the same on every machine: the generator is fixed by the C++ standard
// (its distributions are not), and only exact operations are applied to what it gives.
class Random {
 public:
  // Different streams of one seed are independent: a change in what one part of a simulation draws
  // does not change the others.
  Random(std::uint64_t seed, std::uint32_t stream) : generator_(seeded(seed, stream)) {}

  // 0 ≤ u < 1.
  [[nodiscard]] double uniform() { return static_cast<double>(generator_() >> 11U) * 0x1p-53; }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }

  // Mean 0, standard deviation 1: the sum of twelve uniform numbers of 16 bits. Within 6 standard
  // deviations, beyond which a normal variable lies once in 5·10⁸ draws.
  [[nodiscard]] double gaussian() {
    std::uint64_t sum = 0;
    for (int word = 0; word < 3; ++word) {
      const std::uint64_t bits = generator_();
      sum +=
          (bits & 0xFFFFU) + ((bits >> 16U) & 0xFFFFU) + ((bits >> 32U) & 0xFFFFU) + (bits >> 48U);
    }
    constexpr double kMeanOfSum = 12 * 0xFFFF / 2.0;
    return (static_cast<double>(sum) - kMeanOfSum) * 0x1p-16;
  }

 private:
  static std::mt19937_64 seeded(std::uint64_t seed, std::uint32_t stream) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed),
                           static_cast<std::uint32_t>(seed >> 32U), stream};
    return std::mt19937_64(sequence);
  }

  std::mt19937_64 generator_;
};

}  // namespace convexcut::sim
