// SPDX-License-Identifier: Apache-2.0
#include "core/planes/planelets.hpp"

#include <cmath>

namespace convexcut {

PlaneletFinder::PlaneletFinder(const PlaneOptions& options) : options_(options), fitter_(options) {}

void PlaneletFinder::find(const CellTree& tree, std::vector<Planelet>& planelets,
                          Workspace<std::uint32_t>& planelet_of_point) {
  planelets.clear();
  planelet_of_point.assign(tree.size(), kNoPlanelet);
  planelets_ = &planelets;
  planelet_of_point_ = &planelet_of_point;
  const CellTree::Range all = tree.all();
  for (std::uint32_t at = all.begin; at < all.end;) {
    const CellTree::Range cell = tree.cell_at(at, all.end, tree.levels());
    visit(tree, cell, tree.levels());
    at = cell.end;
  }
}

void PlaneletFinder::visit(const CellTree& tree, CellTree::Range range, std::uint32_t level) {
  if (range.size() < options_.least_cell_points) return;
  free_.clear();
  free_points_.clear();
  for (std::uint32_t i = range.begin; i < range.end; ++i) {
    if ((*planelet_of_point_)[i] != kNoPlanelet) continue;
    free_.add(tree.x()[i], tree.y()[i], tree.z()[i]);
    free_points_.push_back(i);
  }
  std::size_t left = free_.size();
  if (fitter_.fit(free_, found_)) left -= take_inliers(tree);
  if (level == 0 || left < options_.least_cell_points) return;
  for (std::uint32_t at = range.begin; at < range.end;) {
    const CellTree::Range cell = tree.cell_at(at, range.end, level - 1);
    visit(tree, cell, level - 1);
    at = cell.end;
  }
}

std::size_t PlaneletFinder::take_inliers(const CellTree& tree) {
  Planelet planelet{found_.inliers, found_.fit, {}};
  const auto number = static_cast<std::uint32_t>(planelets_->size());
  const FloatPlane plane(found_.fit.plane);
  std::size_t taken = 0;
  for (const std::uint32_t i : free_points_) {
    const Vec3f p(tree.x()[i], tree.y()[i], tree.z()[i]);
    if (std::abs(plane.signed_distance_m(p.x(), p.y(), p.z())) > fitter_.reach_m()) continue;
    (*planelet_of_point_)[i] = number;
    planelet.box.extend(p);
    ++taken;
  }
  planelets_->push_back(planelet);
  return taken;
}

}  // namespace convexcut
