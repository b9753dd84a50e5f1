// SPDX-License-Identifier: Apache-2.0
#include "bench/planes/region_growing.hpp"

#include <cstddef>
#include <iterator>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_point_set.h>
#include <CGAL/pca_estimate_normals.h>
#include <CGAL/property_map.h>

#include "core/planes/plane_patch.hpp"

namespace convexcut::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using PointWithNormal = std::pair<Kernel::Point_3, Kernel::Vector_3>;
using Points = std::vector<PointWithNormal>;
using PointMap = CGAL::First_of_pair_property_map<PointWithNormal>;
using NormalMap = CGAL::Second_of_pair_property_map<PointWithNormal>;
using Neighbours =
    CGAL::Shape_detection::Point_set::Sphere_neighbor_query<Kernel, Points, PointMap>;
using PlaneRegion =
    CGAL::Shape_detection::Point_set::Least_squares_plane_fit_region<Kernel, Points, PointMap,
                                                                     NormalMap>;
using Growing = CGAL::Shape_detection::Region_growing<Points, Neighbours, PlaneRegion>;

}  // namespace

std::uint32_t grow_regions(const CloudView& cloud, const RegionGrowing& options,
                           std::vector<std::uint32_t>& patch_of_point) {
  Points points;
  points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    points.emplace_back(Kernel::Point_3(cloud.x[i], cloud.y[i], cloud.z[i]), Kernel::Vector_3());
  }
  CGAL::pca_estimate_normals<CGAL::Sequential_tag>(points, 0,
                                                   CGAL::parameters::point_map(PointMap())
                                                       .normal_map(NormalMap())
                                                       .neighbor_radius(options.radius_m));
  Neighbours neighbours(points, options.radius_m);
  PlaneRegion region(points, options.distance_m, options.angle_deg, options.least_points);
  Growing growing(points, neighbours, region);
  patch_of_point.assign(cloud.size(), kNoPatch);
  std::uint32_t count = 0;
  std::vector<std::vector<std::size_t>> regions;
  growing.detect(std::back_inserter(regions));
  for (const auto& members : regions) {
    for (const std::size_t point : members) patch_of_point[point] = count;
    ++count;
  }
  return count;
}

}  // namespace convexcut::bench
