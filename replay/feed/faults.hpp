// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "core/time.hpp"

namespace convexcut::replay {

// What shall go wrong. Probabilities are those of each record.
struct Faults {
  double loss = 0;
  double duplicate = 0;
  double reorder = 0;  // it is sent after the one that follows it
  double garbage = 0;  // something that is no packet is sent after it
  Duration delay{};    // it is sent up to this much later, in order
  Duration stall{};    // silence at the end of each stall_every
  Duration stall_every{};

  // Whether the sensors are silent at this time after the start.
  [[nodiscard]] bool stalled(Duration elapsed) const noexcept {
    if (stall <= Duration{0} || stall_every <= Duration{0}) return false;
    return elapsed % stall_every >= stall_every - stall;
  }
};

// Decides by chance, the same for the same seed on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed) {}

  [[nodiscard]] bool chance(double probability) {
    return probability > 0 && uniform() < probability;
  }
  [[nodiscard]] Duration up_to(Duration longest) {
    return Duration{static_cast<Duration::rep>(uniform() * static_cast<double>(longest.count()))};
  }
  // Between nothing and `longest` random bytes.
  [[nodiscard]] std::vector<std::byte> noise(std::size_t longest) {
    std::vector<std::byte> bytes(generator_() % (longest + 1));
    for (std::byte& b : bytes) b = static_cast<std::byte>(generator_());
    return bytes;
  }

 private:
  [[nodiscard]] double uniform() { return static_cast<double>(generator_() >> 11U) * 0x1p-53; }

  std::mt19937_64 generator_;
};

}  // namespace convexcut::replay
