// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/convex_hull.hpp"

#include <algorithm>

#include "core/convex_cut/orientation.hpp"

namespace convexcut {
namespace {

// Appends a point to the half hull that begins at `start`; turns that are not to the left go.
void extend(std::span<SlicePoint> vertices, std::size_t start, std::size_t& size,
            SlicePoint next) noexcept {
  while (size >= start + 2 && orientation(vertices[size - 2], vertices[size - 1], next) <= 0) {
    --size;
  }
  vertices[size++] = next;
}

}  // namespace

std::span<const SlicePoint> convex_hull(std::span<SlicePoint> points,
                                        std::span<SlicePoint> vertices) noexcept {
  std::sort(points.begin(), points.end());
  const auto unique_end = std::unique(points.begin(), points.end());
  const auto n = static_cast<std::size_t>(unique_end - points.begin());
  if (n < 3) {
    std::copy_n(points.begin(), n, vertices.begin());
    return vertices.first(n);
  }

  std::size_t size = 0;
  for (std::size_t i = 0; i < n; ++i) extend(vertices, 0, size, points[i]);  // below, to the right
  const std::size_t rightmost = size - 1;
  for (std::size_t i = n - 1; i-- > 0;) extend(vertices, rightmost, size, points[i]);  // and back
  return vertices.first(size - 1);  // the leftmost came twice
}

}  // namespace convexcut
