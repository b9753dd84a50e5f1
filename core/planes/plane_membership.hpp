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

// How the points about a region's plane fell.
struct Support {
  std::uint32_t points = 0;   // its own
  std::uint32_t shared = 0;   // of these, within reach of a region with more points as well
  std::uint32_t outside = 0;  // beside the plane: at once to twice the reach, in cells where the
                              // region has points; those of regions that are surely sheets, or
                              // have four times its points, are not counted
  bool sure = false;          // it stood out clearly in the round before this one

  // Whether there is a sheet of its own: it stands out from what is beside it (in clutter as many
  // points are outside as are on the plane), and larger ones do not explain it.
  [[nodiscard]] bool is_sheet() const noexcept {
    return points >= 3 * outside && points >= 2 * shared;
  }
  // By more, and with more points, than a plane has that takes the densest part of clutter.
  [[nodiscard]] bool is_surely_sheet() const noexcept {
    return points >= 100 && points >= 6 * outside && points >= 2 * shared;
  }
};

class PlaneMembership {
 public:
  explicit PlaneMembership(const PlaneOptions& options);

  // Before the first assign() of a cloud.
  void begin(const CellTree& tree) { shared_.assign(tree.size(), 0); }

  // Gives every point the nearest plane within reach (3 σ of the noise), of the regions that have
  // points in the point's cell (0.4 m by default) or in one beside it; kNoPatch when there is none.
  // On entry `region_of_point` says where the regions are; points that larger regions reach as well
  // do not count for this, or a plane would creep along its intersections with others. `support`
  // has one for each region: those of the round before on entry, new ones on return.
  void assign(const CellTree& tree, std::span<const PlaneMerger::Region> regions,
              Workspace<std::uint32_t>& region_of_point, std::vector<Support>& support);

 private:
  struct Cell {
    std::uint64_t key;
    CellTree::Range points;
    std::uint32_t first_region;  // in regions_, up to that of the next cell
  };
  struct Candidate {
    std::uint32_t region;
    FloatPlane plane;
    std::uint32_t points;
    bool sure;
    bool here;  // it has points in the cell itself
  };
  void list_regions(const CellTree& tree, const Workspace<std::uint32_t>& region_of_point);
  void gather_candidates(std::size_t cell, std::span<const PlaneMerger::Region> regions,
                         std::span<const Support> support);
  struct Verdict {
    std::uint32_t region;
    bool shared;  // a region with more points reaches it as well
  };
  [[nodiscard]] Verdict judge(float x, float y, float z, std::vector<Support>& support);

  std::uint32_t level_;  // of the cells
  float reach_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> regions_;  // of each cell, rising
  std::vector<std::uint32_t> near_regions_;
  std::vector<Candidate> candidates_;  // with the most points first
  std::vector<float> distances_;       // of a point from each
  Workspace<std::uint8_t> shared_;     // by point
};

}  // namespace convexcut
