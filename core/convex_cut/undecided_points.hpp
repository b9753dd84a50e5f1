// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/cloud.hpp"
#include "core/convex_cut/cloud_kernels.hpp"
#include "core/workspace.hpp"

namespace convexcut {

// Points that slices leave undecided, with their coordinates: at the end they would come one by one
// from memory. RT: no allocation, no lock, no system call.
class UndecidedPoints {
 public:
  // Allocates 16 bytes a point. Until then there is room for none.
  void reserve(std::size_t most) {
    most_ = most;
    for (auto* column : {&x_, &y_, &z_}) column->resize(most + kKernelPadding);
    points_.resize(most);
  }
  void clear() noexcept { size_ = 0; }

  // point: in the cloud. False when there is no room.
  [[nodiscard]] bool add(const CloudView& cloud, std::uint32_t point) noexcept {
    if (size_ == most_) return false;
    x_[size_] = cloud.x[point];
    y_[size_] = cloud.y[point];
    z_[size_] = cloud.z[point];
    points_[size_++] = point;
    return true;
  }

  // Drops those that are structure by now: counts, of each point of the cloud.
  void prune(std::span<const std::uint8_t> counts) noexcept {
    std::size_t left = 0;
    for (std::size_t k = 0; k < size_; ++k) {
      x_[left] = x_[k];
      y_[left] = y_[k];
      z_[left] = z_[k];
      points_[left] = points_[k];
      left += counts[points_[k]] == 0 ? 1U : 0U;
    }
    size_ = left;
  }

  [[nodiscard]] std::span<const std::uint32_t> points() const noexcept {
    return std::span(points_).first(size_);
  }
  // Of these; kKernelPadding elements more can be read.
  [[nodiscard]] CloudView columns() const noexcept {
    return {{x_.data(), size_}, {y_.data(), size_}, {z_.data(), size_}};
  }

 private:
  std::size_t most_ = 0;
  std::size_t size_ = 0;
  Workspace<float> x_, y_, z_;
  Workspace<std::uint32_t> points_;
};

}  // namespace convexcut
