// SPDX-License-Identifier: Apache-2.0
//
// The paper's Algorithm 1 as a reader would write it, with a hull from a library: the peers that
// the engine is compared with.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "core/convex_cut/parameters.hpp"
#include "core/convex_cut/slice_point.hpp"

namespace convexcut::bench {

// The vertices of the convex hull in order; fewer than three when it is degenerate.
using HullFunction = std::vector<SlicePoint> (*)(std::span<const SlicePoint> points);

// Qhull (libqhull_r, options "qhull Pp"): the paper's own choice.
[[nodiscard]] std::vector<SlicePoint> hull_by_qhull(std::span<const SlicePoint> points);
// CGAL::convex_hull_2 with double coordinates and exact predicates.
[[nodiscard]] std::vector<SlicePoint> hull_by_cgal(std::span<const SlicePoint> points);
// Andrew's monotone chain with plain double predicates.
[[nodiscard]] std::vector<SlicePoint> hull_by_monotone_chain(std::span<const SlicePoint> points);

// For each plane: test all points, project those within half_width_m, take their hull, keep those
// within hull_distance_m of its boundary.
void label_literally(const ConvexCutParameters& parameters, const CloudView& cloud,
                     HullFunction hull, std::span<Label> labels);

}  // namespace convexcut::bench
