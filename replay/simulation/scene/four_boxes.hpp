// SPDX-License-Identifier: Apache-2.0
//
// Boxes along the axes as floats, four at a time, and the question which of them a ray may meet.
// The answer is never a false no: boxes are padded by more than float rounds their coordinates, and
// distances, which round by parts of themselves, are compared with slack.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "replay/simulation/scene/bounds.hpp"
#include "replay/simulation/scene/ray.hpp"

namespace convexcut::simulation {

// Metres, ±: within this a float box is exact to 0.03 mm, less than its padding.
inline constexpr double kLargestCoordinate = 500.0;

struct FourBoxes {
  using Lanes = std::array<float, 4>;
  std::array<std::array<Lanes, 3>, 2> sides;  // [low, high][axis]

  // Four boxes that no ray meets.
  [[nodiscard]] static FourBoxes nothing() noexcept {
    FourBoxes boxes;
    for (Lanes& lanes : boxes.sides[0]) lanes.fill(std::numeric_limits<float>::infinity());
    for (Lanes& lanes : boxes.sides[1]) lanes.fill(-std::numeric_limits<float>::infinity());
    return boxes;
  }

  void set(std::size_t lane, const Bounds& bounds) noexcept {
    constexpr double kPaddingM = 1e-4;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto index = static_cast<Eigen::Index>(axis);
      sides[0][axis][lane] = static_cast<float>(bounds.low[index] - kPaddingM);
      sides[1][axis][lane] = static_cast<float>(bounds.high[index] + kPaddingM);
    }
  }
};

// The compilers make one instruction of each operation on these.
using Floats = float __attribute__((vector_size(16)));

// A ray as the boxes need it.
class BoxRay {
 public:
  explicit BoxRay(const Ray& ray) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto index = static_cast<Eigen::Index>(axis);
      // Not 0: the interval of an axis that is not moved along is then everything or nothing.
      constexpr double kLeast = 1e-20;
      const double d = ray.direction[index];
      const double safe = std::abs(d) < kLeast ? kLeast : d;
      backwards_[axis] = safe < 0.0 ? 1 : 0;
      origin_[axis] = all(static_cast<float>(ray.origin[index]));
      inverse_[axis] = all(static_cast<float>(1.0 / safe));
    }
    least_ = all(static_cast<float>(ray.min_distance_m) * (1.0F - kRelativeSlack) - kSlackM);
  }

  // Calls met(lane, where the ray enters) for each box that the ray may meet before `limit`.
  template <class Met>
  void meet(const FourBoxes& boxes, float limit, Met&& met) const noexcept {
    Floats enter = least_;
    Floats leave = all(limit);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t backwards = backwards_[axis];
      const Floats near = load(boxes.sides[backwards][axis]);
      const Floats far = load(boxes.sides[1 - backwards][axis]);
      enter = larger(enter, (near - origin_[axis]) * inverse_[axis]);
      leave = smaller(leave, (far - origin_[axis]) * inverse_[axis]);
    }
    const auto hits = enter <= leave * all(1.0F + kRelativeSlack);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if (hits[lane] != 0) met(lane, enter[lane]);
    }
  }

  // What is not nearer than this is not nearer than `distance_m`.
  [[nodiscard]] static float limit_of(double distance_m) noexcept {
    return static_cast<float>(distance_m) * (1.0F + kRelativeSlack) + kSlackM;
  }

 private:
  static constexpr float kRelativeSlack = 1e-6F;
  static constexpr float kSlackM = 1e-4F;

  static Floats all(float value) noexcept { return Floats{value, value, value, value}; }
  static Floats larger(Floats a, Floats b) noexcept { return a > b ? a : b; }
  static Floats smaller(Floats a, Floats b) noexcept { return a < b ? a : b; }
  static Floats load(const FourBoxes::Lanes& lanes) noexcept {
    Floats floats;
    std::memcpy(&floats, lanes.data(), sizeof floats);
    return floats;
  }

  std::array<Floats, 3> origin_;
  std::array<Floats, 3> inverse_;
  std::array<std::size_t, 3> backwards_;
  Floats least_;
};

}  // namespace convexcut::simulation
