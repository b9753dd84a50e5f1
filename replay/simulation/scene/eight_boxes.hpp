// SPDX-License-Identifier: Apache-2.0
//
// Boxes along the axes as floats, eight at a time, and the question which of them a ray may meet.
// The answer is never a false no: boxes are padded by more than float rounds their coordinates, and
// distances, which round by parts of themselves, are compared with slack.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "replay/simulation/scene/bounds.hpp"
#include "replay/simulation/scene/four_floats.hpp"
#include "replay/simulation/scene/ray.hpp"

namespace convexcut::simulation {

// Metres, ±: within this a float box is exact to 0.03 mm, less than its padding.
inline constexpr double kLargestCoordinate = 500.0;

struct EightBoxes {
  static constexpr std::size_t kLanes = 8;
  using Lanes = std::array<float, kLanes>;
  std::array<std::array<Lanes, 3>, 2> sides;  // [low, high][axis]

  // Boxes that no ray meets.
  [[nodiscard]] static EightBoxes nothing() noexcept {
    EightBoxes boxes;
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
  void copy(std::size_t lane, const EightBoxes& from, std::size_t from_lane) noexcept {
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sides[side][axis][lane] = from.sides[side][axis][from_lane];
      }
    }
  }
};

// A ray as the boxes need it.
class BoxRay {
 public:
  explicit BoxRay(const Ray& ray) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto index = static_cast<Eigen::Index>(axis);
      const double safe = not_zero(ray.direction[index]);
      backwards_[axis] = safe < 0.0 ? 1 : 0;
      origin_[axis] = all(static_cast<float>(ray.origin[index]));
      inverse_[axis] = all(static_cast<float>(1.0 / safe));
    }
    const float least = static_cast<float>(ray.min_distance_m) * (1.0F - kRelativeSlack) - kSlackM;
    least_ = all(std::max(least, 0.0F));
  }

  // Calls met(lane, where the ray enters, ≥ 0) for each of the first `lanes` boxes that the ray may
  // meet before `limit`.
  template <class Met>
  void meet(const EightBoxes& boxes, float limit, Met&& met,
            std::size_t lanes = EightBoxes::kLanes) const noexcept {
    unsigned hits = 0;
    EightBoxes::Lanes enters;
    for (std::size_t first = 0; first < lanes; first += 4) {
      Floats enter = least_;
      Floats leave = all(limit);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t backwards = backwards_[axis];
        const Floats near = load(boxes.sides[backwards][axis].data() + first);
        const Floats far = load(boxes.sides[1 - backwards][axis].data() + first);
        enter = larger(enter, (near - origin_[axis]) * inverse_[axis]);
        leave = smaller(leave, (far - origin_[axis]) * inverse_[axis]);
      }
      hits |= bits_of(enter <= leave * all(1.0F + kRelativeSlack)) << first;
      std::memcpy(enters.data() + first, &enter, sizeof enter);
    }
    for (; hits != 0; hits &= hits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(hits));
      met(lane, enters[lane]);
    }
  }

  // The interval of an axis that is not moved along is then everything or nothing.
  [[nodiscard]] static double not_zero(double direction) noexcept {
    constexpr double kLeast = 1e-20;
    return std::abs(direction) < kLeast ? kLeast : direction;
  }
  // What is not nearer than this is not nearer than `distance_m`.
  [[nodiscard]] static float limit_of(double distance_m) noexcept {
    return static_cast<float>(distance_m) * (1.0F + kRelativeSlack) + kSlackM;
  }

  static constexpr float kRelativeSlack = 1e-6F;

 private:
  static constexpr float kSlackM = 1e-4F;

  std::array<Floats, 3> origin_;
  std::array<Floats, 3> inverse_;
  std::array<std::size_t, 3> backwards_;
  Floats least_;
};

}  // namespace convexcut::simulation
