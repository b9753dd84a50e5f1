// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>

#include "core/convex_cut/robust/plane_search.hpp"
#include "core/convex_cut/robust/shape.hpp"

namespace convexcut::robust {
namespace {

constexpr float kEdgeOnM = 0.10F;          // nearer to the lidar a plane is seen along itself
constexpr std::size_t kLargestPlanes = 4;  // that show the sensor's noise
// Strips have points of what is beside them; small planes may have little else.
constexpr std::uint32_t kLargeSurfels = 60;
constexpr double kLeastCosine2 = 0.05;  // of the beams on a plane: flatter tells little

// Sums over the points of a plane.
struct Sums {
  double points = 0.0;
  double squares = 0.0;       // m², of distances from the plane
  double cosines2 = 0.0;      // of the beams' angles with its normal
  std::uint32_t edge_on = 0;  // surfels
};

// m², of a voxel's points across a plane, about their mean.
[[nodiscard]] float spread2_across(const Voxel& voxel, const Plane& plane) noexcept {
  return plane.normal.dot(covariance(voxel.moments) * plane.normal);
}

// Noise is along the beam, so a surface that is met at an angle shows the less of it. Planes with
// things on them show more: of the largest planes the least counts.
[[nodiscard]] float noise2(const Model& model, std::span<const Sums> sums) noexcept {
  const std::size_t count = std::min(kLargestPlanes, model.planes.size());
  if (count == 0) return Model{}.noise2;
  std::array<std::size_t, PlaneSearch::kMostPlanes> order{};
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(model.planes.size());
  std::iota(order.begin(), end, std::size_t{0});
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), end,
                    [&](std::size_t a, std::size_t b) {
                      const std::uint32_t na = model.planes[a].surfels;
                      const std::uint32_t nb = model.planes[b].surfels;
                      return na > nb || (na == nb && a < b);
                    });
  double least = std::numeric_limits<double>::max();
  for (const std::size_t k : std::span(order).first(count)) {
    const double cosines2 = std::max(sums[k].cosines2, kLeastCosine2 * sums[k].points);
    if (cosines2 > 0.0) least = std::min(least, sums[k].squares / cosines2);
  }
  return static_cast<float>(least);
}

}  // namespace

void measure_spread(Model& model, std::span<const Voxel> voxels) noexcept {
  std::array<Sums, PlaneSearch::kMostPlanes> sums{};
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    Surfel& surfel = model.surfels[i];
    if (surfel.plane == kNoPlane) continue;
    const auto k = static_cast<std::size_t>(surfel.plane);
    const Plane& plane = model.planes[k];
    const float height = plane.height_of(surfel.mean);
    const float cosine = plane.normal.dot((surfel.mean - surfel.origin).normalized());
    surfel.spread2 = spread2_across(voxels[i], plane) + height * height;
    Sums& of_plane = sums.at(k);
    of_plane.edge_on += std::abs(plane.height_of(surfel.origin)) < kEdgeOnM ? 1U : 0U;
    if (surfel.shape == Shape::strip && plane.surfels >= kLargeSurfels) continue;
    of_plane.points += surfel.points;
    of_plane.squares += static_cast<double>(surfel.points) * static_cast<double>(surfel.spread2);
    of_plane.cosines2 += static_cast<double>(surfel.points) * static_cast<double>(cosine * cosine);
  }
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Sums& of_plane = sums.at(k);
    model.planes[k].edge_on = 2 * of_plane.edge_on > model.planes[k].surfels;
    model.planes[k].spread2 = static_cast<float>(of_plane.squares / std::max(of_plane.points, 1.0));
  }
  model.noise2 = noise2(model, sums);
}

}  // namespace convexcut::robust
