// SPDX-License-Identifier: Apache-2.0
#include "bench/convex_cut/literal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace convexcut::bench {
namespace {

struct Slice {
  std::vector<SlicePoint> points;
  std::vector<std::size_t> indices;  // of the points in the cloud
};

void cut(const CloudView& cloud, double angle_rad, double half_width_m, Slice& slice) {
  const double sine = std::sin(angle_rad);
  const double cosine = std::cos(angle_rad);
  slice.points.clear();
  slice.indices.clear();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto x = static_cast<double>(cloud.x[i]);
    const auto y = static_cast<double>(cloud.y[i]);
    if (std::abs(-x * sine + y * cosine) < half_width_m) {
      slice.points.push_back({x * cosine + y * sine, static_cast<double>(cloud.z[i])});
      slice.indices.push_back(i);
    }
  }
}

[[nodiscard]] double squared_distance_from_boundary(const SlicePoint& point,
                                                    std::span<const SlicePoint> hull) {
  double nearest = squared_distance(point, hull.back(), hull.front());
  for (std::size_t k = 1; k < hull.size(); ++k) {
    nearest = std::min(nearest, squared_distance(point, hull[k - 1], hull[k]));
  }
  return nearest;
}

}  // namespace

void label_literally(const ConvexCutParameters& parameters, const CloudView& cloud,
                     HullFunction hull, std::span<Label> labels) {
  std::ranges::fill(labels, Label::other);
  const double e = parameters.hull_distance_m;
  Slice slice;
  for (std::uint32_t i = 0; i < parameters.planes; ++i) {
    cut(cloud, std::numbers::pi * i / parameters.planes, parameters.half_width_m, slice);
    const std::vector<SlicePoint> boundary = hull(slice.points);
    for (std::size_t k = 0; k < slice.points.size(); ++k) {
      if (boundary.size() < 3 ||
          squared_distance_from_boundary(slice.points[k], boundary) <= e * e) {
        labels[slice.indices[k]] = Label::structure;
      }
    }
  }
}

}  // namespace convexcut::bench
