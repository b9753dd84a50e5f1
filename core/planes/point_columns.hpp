// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/planes/moments.hpp"
#include "core/planes/plane_patch.hpp"

namespace convexcut {

// Points as a structure of arrays that is filled again and again.
struct PlanePoints {
  std::vector<float> x, y, z;

  [[nodiscard]] std::size_t size() const noexcept { return x.size(); }
  void clear() noexcept {
    x.clear();
    y.clear();
    z.clear();
  }
  void add(float px, float py, float pz) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
  }
  [[nodiscard]] Moments moments() const noexcept { return Moments::of(x, y, z); }
};

// A plane in single precision, for many points at once.
struct FloatPlane {
  float nx, ny, nz, offset;

  explicit FloatPlane(const Plane& plane) noexcept
      : nx(static_cast<float>(plane.normal.x())),
        ny(static_cast<float>(plane.normal.y())),
        nz(static_cast<float>(plane.normal.z())),
        offset(static_cast<float>(plane.offset_m)) {}
  [[nodiscard]] float signed_distance_m(float x, float y, float z) const noexcept {
    return nx * x + ny * y + nz * z - offset;
  }
};

}  // namespace convexcut
