// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/convex_cut/column.hpp"
#include "core/convex_cut/polygon_kernels.hpp"
#include "core/convex_cut/slice_kernels.hpp"

namespace convexcut {

// Room for a polygon's edges, and for those of them that face what is at hand.
class EdgeWorkspace {
  Column<float> normal_u_, normal_z_, offset_, least_u_, most_u_;
  Column<float> facing_normal_u_, facing_normal_z_, facing_offset_;

 public:
  // first_column: the first of eight indices of Column.
  EdgeWorkspace(std::size_t most_edges, std::size_t first_column)
      : normal_u_(most_edges + kKernelPadding, first_column),
        normal_z_(most_edges + kKernelPadding, first_column + 1),
        offset_(most_edges + kKernelPadding, first_column + 2),
        least_u_(most_edges + kKernelPadding, first_column + 3),
        most_u_(most_edges + kKernelPadding, first_column + 4),
        facing_normal_u_(most_edges + kKernelPadding, first_column + 5),
        facing_normal_z_(most_edges + kKernelPadding, first_column + 6),
        facing_offset_(most_edges + kKernelPadding, first_column + 7),
        edges{
            {normal_u_.data(), normal_z_.data(), offset_.data()}, least_u_.data(), most_u_.data()},
        facing{facing_normal_u_.data(), facing_normal_z_.data(), facing_offset_.data()} {}

  PolygonEdges edges;
  EdgeColumns facing;
};

}  // namespace convexcut
