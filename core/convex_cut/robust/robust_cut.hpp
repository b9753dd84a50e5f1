// SPDX-License-Identifier: Apache-2.0
//
// The second method: what bounds the free space seen from the sensor is structure, made dependable.
// It looks at all directions at once instead of one slice, at several revolutions, and asks of each
// surface whether something is seen behind it where structure would have stood. See
// docs/design/robust.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "core/convex_cut/parameters.hpp"
#include "core/convex_cut/robust/alignment.hpp"
#include "core/convex_cut/robust/curved.hpp"
#include "core/convex_cut/robust/fixtures.hpp"
#include "core/convex_cut/robust/flat_surfaces.hpp"
#include "core/convex_cut/robust/layer_edge.hpp"
#include "core/convex_cut/robust/mirrors.hpp"
#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/parameters.hpp"
#include "core/convex_cut/robust/pillars.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/plane_search.hpp"
#include "core/convex_cut/robust/pose.hpp"
#include "core/convex_cut/robust/recesses.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"
#include "core/convex_cut/robust/walls.hpp"
#include "core/convex_cut/robust/window.hpp"
#include "core/geometry.hpp"
#include "core/workspace.hpp"

namespace convexcut {

class RobustCut {
 public:
  // Allocates everything it will ever need: 4 bytes a point and about 80 MB for thirty
  // revolutions. Throws std::invalid_argument when the parameters are not valid or max_points
  // exceeds 2³¹, and std::bad_alloc.
  RobustCut(const RobustParameters& parameters, std::size_t max_points);

  // Labels every point of a revolution in frame level, and remembers it for those that follow. The
  // points are expected in firing order; any order gives labels, at most less precise ones for a
  // moving rig. position_m: the lidar in any fixed frame with level's axes, where it is known;
  // without, a motion is found from the planes as far as they hold it. window: at most this many
  // revolutions decide. One thread at a time; the labels depend on the calls since construction or
  // forget() alone. On any answer but `ok` no label has been written and nothing is remembered. RT:
  // no allocation, no lock, no system call.
  [[nodiscard]] CutStatus label(const CloudView& cloud, std::span<Label> labels,
                                const std::optional<Vec3>& position_m = std::nullopt,
                                std::uint32_t window = kMaxRobustWindow) noexcept;

  // The same in two steps, for whoever needs the labels sooner than the revolution can be learnt
  // from: label_at_once() by what the revolutions before it have shown, and, once the labels are
  // handed on, learn(). Where nothing was known, accepted planes go on. A revolution that is the
  // first, or does not fit those before, is learnt from at once. One that is followed by another
  // without learn() is not remembered. RT, both.
  [[nodiscard]] CutStatus label_at_once(
      const CloudView& cloud, std::span<Label> labels,
      const std::optional<Vec3>& position_m = std::nullopt) noexcept;
  enum class Learning : std::uint8_t {
    now,
    later,  // the revolution is remembered only, as far as there is room: walls stay as known
  };
  // Whether it was learnt from: not what was only remembered, nor what had been learnt from before.
  bool learn(Learning learning = Learning::now, std::uint32_t window = kMaxRobustWindow) noexcept;

  // As if newly made: after a gap in time, or a step of the clock.
  void forget() noexcept;

  [[nodiscard]] const RobustParameters& parameters() const noexcept { return parameters_; }
  [[nodiscard]] std::size_t max_points() const noexcept { return max_points_; }
  // Of the revolution learnt from last.
  [[nodiscard]] const robust::Model& model() const noexcept { return model_; }

 private:
  // An accepted plane near a voxel.
  struct NearPlane {
    float inset_m = 0.0F;    // of a door or a pane, see Cell
    std::uint16_t edge = 0;  // of a layer on the plane, in edges_; 0: none
    std::uint8_t plane = 0;
    bool goes_on = false;  // to here, where nothing is known
  };
  // Of a voxel: the planes near it, and what was decided of its points.
  struct Near {
    static constexpr std::size_t kMost = 4;
    std::array<NearPlane, kMost> planes{};
    std::uint8_t count = 0;
    bool unexplained = false;                               // by planes, but structure
    robust::Recesses::Id recess = robust::Recesses::kNone;  // whose side it is
    robust::Verdict verdict = robust::Verdict::as_now;
    std::int32_t structure = 0;  // points
  };

  [[nodiscard]] CutStatus check(const CloudView& cloud, std::span<Label> labels) const noexcept;
  [[nodiscard]] robust::RigPose predicted(const std::optional<Vec3>& position_m) const noexcept;
  void place(const CloudView& cloud, const std::optional<Vec3>& position_m) noexcept;
  void fill_voxels(const CloudView& cloud) noexcept;
  void analyse() noexcept;
  void take_surfels() noexcept;
  void find_structure() noexcept;
  // Whether the model has a surfel of the window's voxel: not of those it was not yet learnt from.
  [[nodiscard]] bool is_known(std::int32_t in_window) const noexcept {
    return static_cast<std::size_t>(in_window) < model_.surfels.size();
  }
  void take_near() noexcept;
  [[nodiscard]] Near near_of(std::int32_t in_window, const Vec3f& centre,
                             std::uint64_t planes) noexcept;
  [[nodiscard]] std::uint16_t edge_of(std::size_t in_window, std::size_t plane) noexcept;
  [[nodiscard]] bool is_structure(const Vec3f& p, std::int32_t voxel) const noexcept;
  void write_labels(const CloudView& cloud, std::span<Label> labels) noexcept;
  void label_points(const CloudView& cloud, std::span<Label> labels) noexcept;
  [[nodiscard]] bool judge_voxels() noexcept;
  void steady(const CloudView& cloud, std::span<Label> labels) const noexcept;
  [[nodiscard]] bool is_restored(robust::Verdict verdict, const Vec3f& p,
                                 std::size_t voxel) const noexcept;

  RobustParameters parameters_;
  std::size_t max_points_;
  robust::VoxelMap revolution_;
  Workspace<std::int32_t> voxel_of_point_;
  robust::Window window_;
  robust::Model model_;
  robust::Alignment alignment_;
  robust::PlaneSearch plane_search_;
  robust::PlaneGrids grids_;
  robust::FlatSurfaces flat_surfaces_;
  robust::Walls walls_;
  robust::Fixtures fixtures_;
  robust::Mirrors mirrors_;
  robust::Curved curved_;
  robust::Pillars pillars_;
  robust::Recesses recesses_;
  std::span<const std::uint8_t> is_curved_, is_pillar_;  // by surfel
  std::vector<robust::LayerEdge> edges_;                 // the first is none
  std::vector<Near> near_;                               // by voxel of the revolution
  robust::RigPose pose_;
  std::optional<Vec3> given_position_m_;  // of the last revolution
  std::size_t points_ = 0;                // of the revolution at hand
  float structure_share_ = 0.0F;          // of the last revolution's points
  bool to_learn_ = false;                 // from the revolution at hand
};

}  // namespace convexcut
