// SPDX-License-Identifier: Apache-2.0
//
// The third step of an extraction: which points are on which plane, whatever cell they are in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/planes/cell_tree.hpp"
#include "core/planes/plane_merging.hpp"

namespace convexcut {

class PlaneMembership {
 public:
  explicit PlaneMembership(const PlaneOptions& options);

  // Gives every point the nearest plane within 3 σ of the noise, of the regions that have points in
  // the point's cell (0.4 m by default) or in one beside it; kNoPatch when there is none. On entry
  // `region_of_point` says where the regions are.
  void assign(const CellTree& tree, std::span<const PlaneMerger::Region> regions,
              Workspace<std::uint32_t>& region_of_point);

 private:
  struct Cell {
    std::uint64_t key;
    CellTree::Range points;
    std::uint32_t first_region;  // in regions_, up to that of the next cell
  };
  void list_regions(const CellTree& tree, const Workspace<std::uint32_t>& region_of_point);
  void gather_candidates(std::size_t cell);

  std::uint32_t level_;  // of the cells
  float reach_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> regions_;  // of each cell, rising
  std::vector<std::uint32_t> candidates_;
};

}  // namespace convexcut
