// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/convex_hull.hpp"

#include <algorithm>

#include "core/convex_cut/orientation.hpp"

namespace convexcut {

std::span<const SlicePoint> convex_hull(std::span<SlicePoint> points,
                                        std::span<SlicePoint> vertices) noexcept {
  std::sort(points.begin(), points.end());
  const auto unique_end = std::unique(points.begin(), points.end());
  const auto n = static_cast<std::size_t>(unique_end - points.begin());
  std::size_t size = 0;
  // Adds a point to the chain whose first vertex is at `start`: turns that are not to the left go.
  const auto add = [&](const SlicePoint& point, std::size_t start) {
    while (size >= start + 2 && orientation(vertices[size - 2], vertices[size - 1], point) <= 0) {
      --size;
    }
    vertices[size++] = point;
  };
  for (std::size_t i = 0; i < n; ++i) add(points[i], 0);  // below, from left to right
  if (n < 3) return vertices.first(size);
  const std::size_t rightmost = size - 1;
  for (std::size_t i = n - 1; i-- > 0;) add(points[i], rightmost);  // above, back to the left
  return vertices.first(size - 1);                                  // the leftmost came twice
}

}  // namespace convexcut
