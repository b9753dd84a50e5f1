// SPDX-License-Identifier: Apache-2.0
//
// Convex Cut for the worker thread: the labels of reference::label(), bit by bit, for every number
// of threads, in a few milliseconds a revolution.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "core/convex_cut/parameters.hpp"
#include "core/convex_cut/shared_step.hpp"
#include "core/convex_cut/shell_index.hpp"
#include "core/convex_cut/slice_worker.hpp"
#include "core/convex_cut/slicing_plane.hpp"
#include "core/convex_cut/worker_team.hpp"
#include "core/workspace.hpp"

namespace convexcut {

class ConvexCutEngine {
 public:
  // Allocates everything it will ever need: about 40 bytes a point and 110 more for every thread.
  // threads: that work on a cloud, with the calling one (0 counts as 1). Throws
  // std::invalid_argument when the parameters are not valid or max_points exceeds 2³¹,
  // std::bad_alloc, and std::system_error when a thread cannot be started.
  ConvexCutEngine(const ConvexCutParameters& parameters, std::size_t max_points, unsigned threads);

  // Labels every point of a cloud in frame level. One thread at a time. On any answer but `ok` no
  // label has been written. plane_stride ≥ 1: only the planes 0, s, 2s, … cut; where s is a power
  // of two that divides their number, that is exactly Convex Cut with that many planes less (else
  // their angles may be rounded differently). RT: no allocation, no lock; a system call only to
  // wake the team.
  [[nodiscard]] CutStatus label(const CloudView& cloud, std::span<Label> labels,
                                std::uint32_t plane_stride = 1) noexcept;

  [[nodiscard]] const ConvexCutParameters& parameters() const noexcept { return parameters_; }
  [[nodiscard]] std::size_t max_points() const noexcept { return max_points_; }

 private:
  // The steps that the team shares, in turn.
  struct Steps {
    SharedStep count, lay_out, number, place, spread, slices, write;
  };
  void prepare_steps(std::uint32_t plane_stride) noexcept;
  void prepare_step(SharedStep& step, const ShellIndex::Shares& shares) noexcept;
  [[nodiscard]] std::uint32_t cut_planes(std::uint32_t plane_stride) const noexcept;
  void process_slices(SliceWorker& worker, std::uint32_t group,
                      std::uint32_t plane_stride) noexcept;
  void write_labels(std::uint32_t piece, std::span<Label> labels) noexcept;
  [[nodiscard]] float extent_m() const noexcept;

  ConvexCutParameters parameters_;
  std::vector<SlicingPlane> planes_;
  std::vector<ShellIndex::Windows> windows_;  // of each plane
  ShellIndex index_;
  std::size_t max_points_;
  std::vector<std::unique_ptr<SliceWorker>> workers_;
  std::vector<std::uint32_t> magnitudes_;  // of each part of the index: the greatest of it
  Steps steps_;
  WorkerTeam team_;
};

}  // namespace convexcut
