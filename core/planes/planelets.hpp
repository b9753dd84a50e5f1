// SPDX-License-Identifier: Apache-2.0
//
// The first step of an extraction: the flat piece of each cell of an octree, from coarse to fine.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/planes/cell_tree.hpp"
#include "core/planes/point_columns.hpp"
#include "core/planes/robust_plane.hpp"

namespace convexcut {

struct Planelet {
  Moments moments;
  PlaneFit fit;
  Eigen::AlignedBox3f box;
};

inline constexpr std::uint32_t kNoPlanelet = kNoPatch;

// Every cell gives at most one planelet; what is not on it goes to the eight cells that it is made
// of, down to the smallest.
class PlaneletFinder {
 public:
  explicit PlaneletFinder(const PlaneOptions& options);

  // Fills `planelets`, and for each point of the tree its planelet or kNoPlanelet.
  void find(const CellTree& tree, std::vector<Planelet>& planelets,
            Workspace<std::uint32_t>& planelet_of_point);

 private:
  void visit(const CellTree& tree, CellTree::Range range, std::uint32_t level);
  // The free points on the plane that was found; how many.
  std::size_t take_inliers(const CellTree& tree);

  PlaneOptions options_;
  RobustPlaneFitter fitter_;
  RobustFit found_;
  std::vector<Planelet>* planelets_ = nullptr;
  Workspace<std::uint32_t>* planelet_of_point_ = nullptr;
  PlanePoints free_;  // of the cell at hand: points that are on no planelet yet
  std::vector<std::uint32_t> free_points_;
};

}  // namespace convexcut
