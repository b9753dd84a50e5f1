// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/cloud.hpp"

namespace convexcut::bench {

struct RegionGrowing {
  double radius_m = 0.3;  // of a neighbourhood: of the normals and of the growth
  double distance_m = 0.06;
  double angle_deg = 25.0;
  unsigned least_points = 40;
};

// Plane patches by CGAL: normals by principal components, then region growing
// (Shape_detection, F. Lafarge, C. Mallet, 2012). For each point its patch, or kNoPatch; gives the
// number of patches.
std::uint32_t grow_regions(const CloudView& cloud, const RegionGrowing& options,
                           std::vector<std::uint32_t>& patch_of_point);

}  // namespace convexcut::bench
