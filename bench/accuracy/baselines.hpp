// SPDX-License-Identifier: Apache-2.0
//
// What a user would pick instead: three ways to find structure that fit into a page each. One
// revolution, frame level, no memory.
#pragma once

#include <span>
#include <vector>

#include "core/cloud.hpp"

namespace convexcut::bench {

// Farthest-column: what is within 8 cm of the farthest point of its azimuth column (1°, horizontal
// range), and the lowest and the highest 8 cm of the cloud.
void label_farthest_column(const CloudView& cloud, std::span<Label> labels);

// Half-space RANSAC: vertical and horizontal planes through random points that have at least 98 %
// of the cloud on one side, the largest first; of each the points within 6 cm.
void label_half_space_ransac(const CloudView& cloud, std::span<Label> labels);

// 3D hull: what is within 12 cm of the boundary of the cloud's convex hull (Qhull).
void label_hull(const CloudView& cloud, std::span<Label> labels);

}  // namespace convexcut::bench
