// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/convex_cut/cloud_check.hpp"
#include "core/convex_cut/orientation.hpp"

namespace convexcut::reference {
namespace {

// Adds the points in the order given to one half of the hull (Andrew's monotone chain).
template <class Points>
void extend_chain(const Points& points, std::vector<SlicePoint>& chain) {
  const std::size_t start = chain.size();
  for (const SlicePoint& point : points) {
    while (chain.size() >= start + 2 &&
           orientation(chain[chain.size() - 2], chain.back(), point) <= 0) {
      chain.pop_back();
    }
    chain.push_back(point);
  }
  chain.pop_back();  // the other half starts with it
}

}  // namespace

CutStatus label(const ConvexCutParameters& parameters, const CloudView& cloud,
                std::span<Label> labels) {
  const CloudCheck check = check_cloud(cloud, labels.size());
  if (check.status != CutStatus::ok) return check.status;

  const double e = parameters.hull_distance_m;
  std::ranges::fill(labels, Label::other);
  for (std::uint32_t i = 0; i < parameters.planes; ++i) {
    const SlicingPlane plane = slicing_plane(i, parameters.planes);
    const std::vector<std::size_t> slice = cut(cloud, plane, parameters.half_width_m);
    const std::vector<SlicePoint> points = project(cloud, plane, slice);
    const std::vector<SlicePoint> boundary = hull(points);
    const bool degenerate = boundary.size() < 3;
    for (std::size_t k = 0; k < slice.size(); ++k) {
      if (degenerate || squared_distance_to_boundary(points[k], boundary) <= e * e) {
        labels[slice[k]] = Label::structure;
      }
    }
  }
  return CutStatus::ok;
}

std::vector<std::size_t> cut(const CloudView& cloud, const SlicingPlane& plane,
                             double half_width_m) {
  std::vector<std::size_t> slice;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    if (std::abs(plane.offset(cloud.x[k], cloud.y[k])) < half_width_m) slice.push_back(k);
  }
  return slice;
}

std::vector<SlicePoint> project(const CloudView& cloud, const SlicingPlane& plane,
                                std::span<const std::size_t> slice) {
  std::vector<SlicePoint> points;
  points.reserve(slice.size());
  for (const std::size_t k : slice) {
    points.push_back(plane.project(cloud.x[k], cloud.y[k], cloud.z[k]));
  }
  return points;
}

std::vector<SlicePoint> hull(std::vector<SlicePoint> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 2) return points;
  std::vector<SlicePoint> chain;
  extend_chain(points, chain);  // below, from left to right
  std::ranges::reverse(points);
  extend_chain(points, chain);  // above, from right to left
  return chain;
}

double squared_distance_to_boundary(const SlicePoint& point, std::span<const SlicePoint> hull) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < hull.size(); ++k) {
    nearest = std::min(nearest, squared_distance(point, hull[k], hull[(k + 1) % hull.size()]));
  }
  return nearest;
}

}  // namespace convexcut::reference
