// SPDX-License-Identifier: Apache-2.0
//
// Clouds to try Convex Cut on: made by a fixed seed, the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <random>
#include <string_view>
#include <vector>

#include "core/cloud.hpp"

namespace convexcut::test {

// Metres, frame level.
struct Cloud {
  std::vector<float> x, y, z;

  void add(double px, double py, double pz) {
    x.push_back(static_cast<float>(px));
    y.push_back(static_cast<float>(py));
    z.push_back(static_cast<float>(pz));
  }
  void add_from(const Cloud& other, std::size_t k) {
    x.push_back(other.x[k]);
    y.push_back(other.y[k]);
    z.push_back(other.z[k]);
  }
  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] CloudView view() const { return {x, y, z}; }
};

// The standard's distributions differ between libraries; its engines do not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  [[nodiscard]] double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  // 0 … count − 1.
  [[nodiscard]] std::size_t index(std::size_t count) {
    return static_cast<std::size_t>(uniform(0.0, static_cast<double>(count)));
  }
  // Mean 0, variance 1, within ±6 (sum of twelve uniform deviates).
  [[nodiscard]] double normal();

 private:
  std::mt19937_64 engine_;
};

struct Distribution {
  std::string_view name;
  Cloud (*make)(Random& random);

  // How GoogleTest names it.
  friend void PrintTo(const Distribution& distribution, std::ostream* out) {
    *out << distribution.name;
  }
};

// From plain to pathological; each with up to a few thousand points.
[[nodiscard]] const std::vector<Distribution>& distributions();

// `points` returns of a lidar in a furnished room of 8 × 6 × 2.7 m with 2 cm of noise.
[[nodiscard]] Cloud furnished_room(Random& random, std::size_t points);

}  // namespace convexcut::test
