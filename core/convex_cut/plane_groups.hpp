// SPDX-License-Identifier: Apache-2.0
//
// Neighbouring slicing planes in groups, and which groups a point can matter to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/convex_cut/shell_index.hpp"
#include "core/convex_cut/slicing_plane.hpp"

namespace convexcut {

class PlaneGroups {
 public:
  // More groups leave less to do at the end of a revolution, and cost more in all: points near the
  // borders are in two of them.
  static constexpr std::uint32_t kMostGroups = 30;

  // One bit a group.
  struct Reach {
    std::uint32_t ahead = 0;   // on the side of the planes' directions
    std::uint32_t behind = 0;  // on the other side
    // Either side, or too near the axis to be on one.
    std::uint32_t any = 0;
    // Not near the axis: `any` are few. Where a tilted rig sees the floor below itself, points near
    // the axis come all the time.
    bool is_far = false;
  };
  static constexpr int kMostGroupsOfFar = 3;

  explicit PlaneGroups(std::uint32_t planes);

  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
  // Planes [begin, end) of a group.
  [[nodiscard]] std::uint32_t begin(std::uint32_t group) const noexcept;
  [[nodiscard]] std::uint32_t end(std::uint32_t group) const noexcept { return begin(group + 1); }

  [[nodiscard]] const SlicingPlane& plane(std::uint32_t i) const noexcept { return planes_[i]; }
  [[nodiscard]] const ShellIndex::Windows& windows(std::uint32_t i) const noexcept {
    return windows_[i];
  }

  // Of points with a key of ShellIndex: every slice that one may be a member of is in a group of
  // `any`.
  [[nodiscard]] const Reach& reach(std::uint16_t key) const noexcept { return reach_[key]; }

 private:
  std::uint32_t count_;
  std::vector<SlicingPlane> planes_;
  std::vector<ShellIndex::Windows> windows_;
  std::vector<Reach> reach_;  // by key
};

}  // namespace convexcut
