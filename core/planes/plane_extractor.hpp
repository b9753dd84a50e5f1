// SPDX-License-Identifier: Apache-2.0
//
// The plane patches of a cloud, hierarchically and robustly: a plane for each cell of an octree
// from coarse to fine (planelets.hpp, robust_plane.hpp), planelets in one plane joined
// (plane_merging.hpp), and every point given the plane that it is on (plane_membership.hpp).
// docs/design/planes.md.
//
// For clouds of one revolution (70 000 points) as well as of many merged (7 million): the time
// grows with the number of points. The same cloud gives the same patches, bit by bit.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cloud.hpp"
#include "core/planes/plane_membership.hpp"
#include "core/planes/plane_merging.hpp"
#include "core/planes/plane_options.hpp"
#include "core/planes/plane_patch.hpp"
#include "core/planes/planelets.hpp"

namespace convexcut {

class PlaneExtractor {
 public:
  // Throws std::invalid_argument when the options are not valid.
  explicit PlaneExtractor(const PlaneOptions& options = {});

  // Points that are not finite, or absurdly far, are in no patch. The answer holds until the next
  // call. One thread at a time; the memory of earlier calls is used again. Throws
  // std::invalid_argument when x, y and z differ in length or hold 2³² − 1 points or more.
  [[nodiscard]] PlanePatches extract(const CloudView& cloud);

  [[nodiscard]] const PlaneOptions& options() const noexcept { return options_; }

 private:
  void drop_chance_planes();
  void refit();
  void describe(const CloudView& cloud);
  [[nodiscard]] bool is_patch(const PlanePatch& patch) const noexcept;

  PlaneOptions options_;
  CellTree tree_;
  PlaneletFinder finder_;
  PlaneMerger merger_;
  PlaneMembership membership_;
  std::vector<Planelet> planelets_;
  Workspace<std::uint32_t> region_of_point_;  // in the order of the tree
  std::vector<PlaneMerger::Region> regions_;
  std::vector<Support> support_;
  std::vector<PlanePoints> points_of_region_;
  std::vector<std::uint32_t> order_, patch_of_region_;
  std::vector<PlanePatch> patches_;
  std::vector<std::uint32_t> patch_of_point_;
};

}  // namespace convexcut
