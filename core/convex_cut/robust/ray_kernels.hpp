// SPDX-License-Identifier: Apache-2.0
//
// Where rays pass planes, compiled for every instruction set (core/simd). All give the same bits:
// no fused multiply-add, and sums in Eigen's order. RT: no allocation, no lock, no system call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/workspace.hpp"

namespace convexcut::robust {

// So many rays are taken at once.
inline constexpr std::size_t kRaysAtOnce = 512;

// From where the lidar was to what it saw. Whole vectors are read: the columns go on for
// kRaysAtOnce elements behind the last.
class Rays {
 public:
  explicit Rays(std::size_t capacity);

  void clear() noexcept { size_ = 0; }
  // Of a surfel, by its index in the model.
  void add(std::size_t surfel, const Vec3f& origin, const Vec3f& end) noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::uint32_t surfel(std::size_t ray) const noexcept { return surfels_[ray]; }
  // 0 … 2: the origins' coordinates, 3 … 5: the ends'.
  [[nodiscard]] const float* column(std::size_t i) const noexcept {
    return values_.data() + i * stride_;
  }

 private:
  std::size_t stride_;
  std::size_t size_ = 0;
  Workspace<float> values_;
  Workspace<std::uint32_t> surfels_;
};

// Rays that end at least behind_m behind a plane and begin at least in_front_m before it.
struct Passages {
  std::size_t count = 0;
  // Which they are, and where they pass it: the cell of its grid, and along it.
  std::array<std::uint32_t, kRaysAtOnce + 64> ray;
  std::array<std::int32_t, kRaysAtOnce + 64> column, cell;
  std::array<float, kRaysAtOnce + 64> along_m;
};

// Of rays [begin, begin + kRaysAtOnce), those that pass within the plane's rectangle of cells.
void find_passages(const Rays& rays, std::size_t begin, const Plane& plane, const PlaneGrid& grid,
                   float behind_m, float in_front_m, Passages& passages) noexcept;

}  // namespace convexcut::robust
