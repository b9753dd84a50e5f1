// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_cut/orientation.hpp"
#include "core/convex_cut/slice_point.hpp"

namespace convexcut {

// A member of a slice that may be a vertex of its hull.
struct HullPoint : SlicePoint {
  std::uint32_t position;  // in the sorted points
};

namespace detail {

// Few points, most of them nearly in order: moving each to its place beats std::sort.
template <class Point>
void sort_points(std::span<Point> points) noexcept {
  constexpr std::size_t kFew = 64;
  if (points.size() > kFew) {
    std::sort(points.begin(), points.end());
    return;
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point point = points[i];
    std::size_t place = i;
    for (; place > 0 && point < points[place - 1]; --place) points[place] = points[place - 1];
    points[place] = point;
  }
}

// Appends a point to the half hull that begins at `start`; turns that are not to the left go.
template <class Point>
void extend_hull(std::span<Point> vertices, std::size_t start, std::size_t& size,
                 const Point& next) noexcept {
  while (size >= start + 2 && orientation(vertices[size - 2], vertices[size - 1], next) <= 0) {
    --size;
  }
  vertices[size++] = next;
}

}  // namespace detail

// The vertices of the convex hull of `points`, counter-clockwise from the least (u, z), without
// those in the middle of an edge: exact (see orientation.hpp). Fewer than three vertices when the
// points are all equal or collinear; of equal points one is taken. Sorts `points` in place;
// `vertices` has room for one more than there are points. RT: no allocation, no lock, no system
// call.
//
// A. M. Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions", 1979.
template <std::derived_from<SlicePoint> Point>
[[nodiscard]] std::span<const Point> convex_hull(std::span<Point> points,
                                                 std::span<Point> vertices) noexcept {
  detail::sort_points(points);
  const auto unique_end = std::unique(points.begin(), points.end());
  const auto n = static_cast<std::size_t>(unique_end - points.begin());
  if (n < 3) {
    std::copy_n(points.begin(), n, vertices.begin());
    return vertices.first(n);
  }

  std::size_t size = 0;
  for (std::size_t i = 0; i < n; ++i) {  // below, to the right
    detail::extend_hull(vertices, 0, size, points[i]);
  }
  const std::size_t rightmost = size - 1;
  for (std::size_t i = n - 1; i-- > 0;) {  // and back
    detail::extend_hull(vertices, rightmost, size, points[i]);
  }
  return vertices.first(size - 1);  // the leftmost came twice
}

}  // namespace convexcut
