// SPDX-License-Identifier: Apache-2.0
//
// Convex Cut as the paper states it, as plainly as possible: the oracle that ConvexCutEngine is
// held to, label by label. Allocates and takes its time; not for the worker thread.
//
// Source: Jun, Youn, Choi, Medioni, Doh, "Convex Cut: A Realtime Pseudo-Structure Extraction
// Algorithm for 3D Point Cloud Data".
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "core/convex_cut/parameters.hpp"
#include "core/convex_cut/slice_point.hpp"
#include "core/convex_cut/slicing_plane.hpp"

namespace convexcut::reference {

// Writes one label a point. The parameters must be valid.
[[nodiscard]] CutStatus label(const ConvexCutParameters& parameters, const CloudView& cloud,
                              std::span<Label> labels);

// The steps, in order. Metres, frame level.

// 1. Sᵢ: the indices of the points with |v| < half_width_m, in the cloud's order.
[[nodiscard]] std::vector<std::size_t> cut(const CloudView& cloud, const SlicingPlane& plane,
                                           double half_width_m);
// … and Sᵢ projected on the plane, in the same order.
[[nodiscard]] std::vector<SlicePoint> project(const CloudView& cloud, const SlicingPlane& plane,
                                              std::span<const std::size_t> slice);
// 2. Hᵢ: the vertices of the convex hull, counter-clockwise from the least (u, z), without those
// in the middle of an edge. Fewer than three when the points are all equal or collinear.
[[nodiscard]] std::vector<SlicePoint> hull(std::vector<SlicePoint> points);
// 3. Square of the distance of a point from the boundary of a hull of at least three vertices.
[[nodiscard]] double squared_distance_to_boundary(const SlicePoint& point,
                                                  std::span<const SlicePoint> hull);

}  // namespace convexcut::reference
