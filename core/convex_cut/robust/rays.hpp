// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/geometry.hpp"
#include "core/workspace.hpp"

namespace convexcut::robust {

// So many rays are taken at once.
inline constexpr std::size_t kRaysAtOnce = 512;

// From where the lidar was to the surfels that it saw. Whole vectors are read: the columns go on
// for kRaysAtOnce elements behind the last.
class Rays {
 public:
  explicit Rays(std::size_t capacity) : stride_(capacity + kRaysAtOnce) {
    values_.resize(6 * stride_);
    surfels_.resize(capacity);
  }

  void clear() noexcept { size_ = 0; }
  // surfel: its index in the model.
  void add(std::size_t surfel, const Vec3f& origin, const Vec3f& end) noexcept {
    surfels_[size_] = static_cast<std::uint32_t>(surfel);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values_[axis * stride_ + size_] = origin[static_cast<Eigen::Index>(axis)];
      values_[(axis + 3) * stride_ + size_] = end[static_cast<Eigen::Index>(axis)];
    }
    ++size_;
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::uint32_t surfel(std::size_t ray) const noexcept { return surfels_[ray]; }
  [[nodiscard]] Vec3f origin(std::size_t ray) const noexcept { return point(ray, 0); }
  [[nodiscard]] Vec3f end(std::size_t ray) const noexcept { return point(ray, 3); }
  // 0 … 2: the origins' coordinates, 3 … 5: the ends'.
  [[nodiscard]] const float* column(std::size_t i) const noexcept {
    return values_.data() + i * stride_;
  }

 private:
  [[nodiscard]] Vec3f point(std::size_t ray, std::size_t first_column) const noexcept {
    return {column(first_column)[ray], column(first_column + 1)[ray],
            column(first_column + 2)[ray]};
  }

  std::size_t stride_;
  std::size_t size_ = 0;
  Workspace<float> values_;
  Workspace<std::uint32_t> surfels_;
};

}  // namespace convexcut::robust
