// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "core/geometry.hpp"

namespace convexcut::simulation {

// A box along the axes of the frame that it is in, metres. As it is made, it holds nothing.
struct Bounds {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& p) noexcept {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const Bounds& other) noexcept {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  [[nodiscard]] bool empty() const noexcept { return (low.array() > high.array()).any(); }
  [[nodiscard]] Vec3 centre() const noexcept { return (low + high) / 2.0; }
  [[nodiscard]] Vec3 size() const noexcept { return high - low; }
  // Of the six sides.
  [[nodiscard]] double area() const noexcept {
    const Vec3 s = size();
    return 2.0 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
  }
};

}  // namespace convexcut::simulation
