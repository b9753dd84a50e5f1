// SPDX-License-Identifier: Apache-2.0
//
// Convex Cut of a revolution while it comes in: slices whose two half-planes have been swept are
// done during the revolution, so that little remains to be done after its last firing. The labels
// are those of reference::label() of the whole cloud, bit by bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "core/convex_cut/kept_slices.hpp"
#include "core/convex_cut/parameters.hpp"
#include "core/convex_cut/plane_groups.hpp"
#include "core/convex_cut/shell_index.hpp"
#include "core/convex_cut/slice_worker.hpp"
#include "core/convex_cut/undecided_points.hpp"
#include "core/workspace.hpp"

namespace convexcut {

// A group of neighbouring slices is done when both of its sides have points and none has come for a
// while, but near the axis. Nothing is assumed about where later points may lie: one that comes
// into a done slice is compared with its hull, and when the hull grows too far by it, the slice's
// group is done again, at the latest in finish(). So a cloud in any order, or a rig that is tilted
// so far that its beams reach every direction at any time, takes longer but gets the same labels.
// See docs/design/convex_cut.md.
//
// One thread. RT after construction: no allocation, no lock, no system call.
class StreamingCut {
 public:
  // Allocates about 320 bytes a point, of which a revolution touches about half, 6 kB a plane, and
  // up to 4 MB for undecided points. Throws std::invalid_argument when the parameters are not valid
  // or max_points exceeds 2³¹, and std::bad_alloc.
  StreamingCut(const ConvexCutParameters& parameters, std::size_t max_points);

  // Forgets the cloud, for a new one.
  void begin() noexcept;

  // Takes the points that are new in `cloud` (frame level, metres): it begins with the size()
  // points that were there the last time, unchanged. May do slices. When a cloud is refused, so are
  // all that follow until begin().
  CutStatus add(const CloudView& cloud) noexcept;

  // Does what is left and writes the label of each point. `cloud` as for add(). Afterwards begin()
  // is next.
  CutStatus finish(const CloudView& cloud, std::span<Label> labels) noexcept;

  // Points taken since begin().
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  // How often slices have been done since begin(); `again`: those of groups that had been done
  // before they got another point.
  struct Done {
    std::uint32_t slices = 0;
    std::uint32_t again = 0;
  };
  [[nodiscard]] const Done& done() const noexcept { return done_; }

 private:
  struct Group {
    Workspace<std::uint32_t> points;  // in the cloud
    Workspace<std::uint8_t> marks;    // of the points [0, done): the group made it structure
    std::uint32_t count = 0;
    std::uint32_t done = 0;  // as many points as it was done with; 0: not yet
    std::uint32_t near_axis = 0;
    UndecidedPoints undecided;  // by its kept slices; but those that other groups made structure
    std::size_t newest = 0;     // its last point that is not near the axis, in the cloud
  };

  [[nodiscard]] CutStatus take(const CloudView& cloud) noexcept;
  void group_points(std::size_t end) noexcept;
  void do_swept(const CloudView& cloud) noexcept;
  [[nodiscard]] std::array<ShellIndex::Candidates, 2> load_late(
      const CloudView& cloud, std::span<std::uint32_t> points) noexcept;
  [[nodiscard]] bool take_late(const CloudView& cloud, std::uint32_t number) noexcept;
  void do_group(const CloudView& cloud, std::uint32_t number) noexcept;
  void do_slices(std::uint32_t number, bool keep) noexcept;
  void list_undecided(const CloudView& cloud, std::uint32_t number) noexcept;
  void take_back(const CloudView& cloud, std::uint32_t number) noexcept;
  void leave_undecided(const CloudView& cloud, std::uint32_t number, std::uint32_t point) noexcept;
  void reopen(const CloudView& cloud, std::uint32_t point) noexcept;
  void load_points(const CloudView& cloud, std::span<const std::uint32_t> points) noexcept;
  void do_rest(const CloudView& cloud, std::uint32_t left) noexcept;
  void decide(std::uint32_t number) noexcept;

  float inverse_squared_half_width_;
  std::size_t max_points_;
  PlaneGroups planes_;
  ShellIndex index_;
  SliceWorker worker_;
  std::vector<Group> groups_;
  KeptSlices kept_;

  CutStatus status_ = CutStatus::ok;  // of the cloud so far
  std::size_t size_ = 0;
  float extent_m_ = 0.0F;    // the greatest magnitude of a coordinate
  std::uint32_t ahead_ = 0;  // groups that have points on this side
  std::uint32_t behind_ = 0;
  std::uint32_t kept_groups_ = 0;   // their slices are kept for late members
  std::uint32_t stale_groups_ = 0;  // kept, but have to be done again
  std::uint32_t pruned_ = 0;        // whose undecided points were looked at last
  Done done_;
  Workspace<std::uint16_t> keys_;         // of ShellIndex
  Workspace<std::uint8_t> counts_;        // of each point: groups that made it structure
  Workspace<std::uint32_t> rest_;         // points of the groups that are left at the end
  Workspace<std::uint8_t> is_taken_;      // of each point: it is among them
  Workspace<float> x_, y_, z_;            // of the points at hand
  Workspace<std::uint8_t> is_undecided_;  // of these
};

}  // namespace convexcut
