// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut::simulation {

namespace detail {

inline constexpr std::uint64_t kGamma = 0x9E37'79B9'7F4A'7C15;  // 2⁶⁴ / golden ratio, odd

[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t z) noexcept {
  z = (z ^ (z >> 30U)) * 0xBF58'476D'1CE4'E5B9;
  z = (z ^ (z >> 27U)) * 0x94D0'49BB'1331'11EB;
  return z ^ (z >> 31U);
}

}  // namespace detail

// What all places of one stream have in common.
struct RandomStream {
  RandomStream(std::uint64_t seed, std::uint32_t stream) noexcept
      : base(detail::mixed(detail::mixed(seed + detail::kGamma) + stream)) {}
  std::uint64_t base;
};

// Random numbers that are the same on every machine, and that can be had for any place of a
// simulation without drawing those before it: a place is a seed, a stream and an index. SplitMix64
// (G. Steele, D. Lea, C. Flood: "Fast splittable pseudorandom number generators", OOPSLA 2014); the
// distributions use exact operations only.
class Random {
 public:
  // Different streams of one seed are independent, and so are different indices of one stream: a
  // change in what one part of a simulation draws does not change the others.
  Random(std::uint64_t seed, std::uint32_t stream, std::uint64_t index = 0) noexcept
      : Random(RandomStream(seed, stream), index) {}
  Random(const RandomStream& stream, std::uint64_t index) noexcept
      : state_(detail::mixed(stream.base + index)) {}

  [[nodiscard]] std::uint64_t bits() noexcept { return detail::mixed(state_ += detail::kGamma); }

  // As if so many numbers of bits() had been drawn.
  void skip(unsigned count) noexcept { state_ += count * detail::kGamma; }

  // 0 ≤ u < 1.
  [[nodiscard]] double uniform() noexcept { return static_cast<double>(bits() >> 11U) * 0x1p-53; }
  [[nodiscard]] double uniform(double low, double high) noexcept {
    return low + (high - low) * uniform();
  }
  [[nodiscard]] bool chance(double probability) noexcept { return uniform() < probability; }

  // Mean 0, standard deviation 1: the sum of twelve uniform numbers of 16 bits. Within 6 standard
  // deviations, beyond which a normal variable lies once in 5·10⁸ draws.
  [[nodiscard]] double gaussian() noexcept {
    std::uint64_t sum = 0;
    for (int word = 0; word < 3; ++word) {
      const std::uint64_t drawn = bits();
      sum += (drawn & 0xFFFFU) + ((drawn >> 16U) & 0xFFFFU) + ((drawn >> 32U) & 0xFFFFU) +
             (drawn >> 48U);
    }
    constexpr double kMeanOfSum = 12 * 0xFFFF / 2.0;
    return (static_cast<double>(sum) - kMeanOfSum) * 0x1p-16;
  }

 private:
  std::uint64_t state_;
};

}  // namespace convexcut::simulation
