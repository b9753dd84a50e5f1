// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/robust_cut.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/convex_cut/cloud_check.hpp"
#include "core/convex_cut/robust/backs.hpp"
#include "core/convex_cut/robust/point_kernels.hpp"
#include "core/convex_cut/robust/second_look.hpp"
#include "core/convex_cut/robust/shape.hpp"
#include "core/convex_cut/robust/spread.hpp"

namespace convexcut {
namespace {

using robust::Surfel;
using robust::Voxel;
using robust::VoxelMap;

constexpr std::size_t kMostPoints = std::size_t{1} << 31;
constexpr std::size_t kMostVoxels = 24'576;         // of a revolution
constexpr std::size_t kMostWindowVoxels = 131'072;  // of all
constexpr std::size_t kNewVoxels = 2'048;           // of a further revolution: twice a hall's
constexpr std::size_t kMostSegments = 2'048;

// From one revolution to the next, one sigma: by how much a step may differ from the one before.
constexpr float kStepChangeM = 0.02F;
constexpr float kLeastFilled = 0.018F;  // of what a surface across the beams would return
constexpr float kViewSr = 4.5F;         // steradians, of an HDL-32E
constexpr float kLeastOfLastShare = 0.5F;
constexpr float kStillM = 0.02F;  // a step below this is none
constexpr float kLasting = 0.5F;  // of a step that is not given: where no plane holds it, it ends
// Behind a surface that bounds the room is nothing but noise: four sigma. Before it things stand.
constexpr float kBehindM = 0.08F;
constexpr float kHalfDiagonal = 0.87F;  // of a voxel, relative to its edge

[[nodiscard]] const RobustParameters& checked(const RobustParameters& parameters) {
  if (!is_valid(parameters)) throw std::invalid_argument("robust parameters out of range");
  return parameters;
}

[[nodiscard]] std::size_t window_voxels(const RobustParameters& parameters) noexcept {
  return std::min(kMostWindowVoxels, kMostVoxels + parameters.window * kNewVoxels);
}

[[nodiscard]] std::size_t checked(std::size_t max_points) {
  if (max_points > kMostPoints) throw std::invalid_argument("Convex Cut: too many points");
  return max_points;
}

// Of a voxel with a shape, points for which it is believed: a surface that fills a voxel near the
// lidar returns hundreds in a revolution, and what ghosts gather there is far less.
[[nodiscard]] float least_points(float range_m, std::size_t points_of_revolution) noexcept {
  const float solid_angle = robust::kVoxelM * robust::kVoxelM / (range_m * range_m);
  return kLeastFilled * static_cast<float>(points_of_revolution) * solid_angle / kViewSr;
}

// Ghosts gather in a voxel as the window grows, but not on a surface.
[[nodiscard]] bool is_supported(const Surfel& surfel, std::uint32_t revolutions,
                                std::size_t points_of_revolution) noexcept {
  const std::int32_t least = surfel.shape == robust::Shape::other
                                 ? robust::kSupport + static_cast<std::int32_t>(revolutions) - 1
                                 : robust::kSupport;
  if (surfel.points < least) return false;
  // Most have so many more that they need no square root: this is far beyond its rounding.
  constexpr float kSurely = 2.0F * kLeastFilled * robust::kVoxelM * robust::kVoxelM / kViewSr;
  const auto points = static_cast<float>(surfel.points);
  const float range2 = (surfel.mean - surfel.origin).squaredNorm();
  if (points * range2 > kSurely * static_cast<float>(points_of_revolution)) return true;
  const float range_m = std::max(std::sqrt(range2), robust::kVoxelM);
  return points >= least_points(range_m, points_of_revolution);
}

}  // namespace

RobustCut::RobustCut(const RobustParameters& parameters, std::size_t max_points)
    : parameters_(checked(parameters)),
      max_points_(checked(max_points)),
      revolution_(std::min(max_points, kMostVoxels)),
      window_(parameters.window, std::min(max_points, kMostVoxels), window_voxels(parameters)),
      plane_search_(window_voxels(parameters)),
      grids_(window_voxels(parameters)),
      mirrors_(window_voxels(parameters)),
      curved_(window_voxels(parameters)),
      pillars_(window_voxels(parameters)) {
  voxel_of_point_.resize(max_points);
  model_.surfels.reserve(window_voxels(parameters));
  model_.segments.reserve(kMostSegments);
  model_.planes.reserve(robust::PlaneSearch::kMostPlanes);
  near_.reserve(std::min(max_points, kMostVoxels));
  edges_.reserve(1 + std::min(max_points, kMostVoxels));
}

void RobustCut::forget() noexcept {
  window_.clear();
  model_.surfels.clear();
  model_.planes.clear();
  model_.segments.clear();
  pose_ = {};
  given_position_m_.reset();
  structure_share_ = 0.0F;
  to_learn_ = false;
}

CutStatus RobustCut::label(const CloudView& cloud, std::span<Label> labels,
                           const std::optional<Vec3>& position_m, std::uint32_t window) noexcept {
  const CutStatus status = check(cloud, labels);
  if (status != CutStatus::ok) return status;

  place(cloud, position_m);
  fill_voxels(cloud);
  to_learn_ = true;
  static_cast<void>(learn(Learning::now, window));
  write_labels(cloud, labels);
  return status;
}

CutStatus RobustCut::label_at_once(const CloudView& cloud, std::span<Label> labels,
                                   const std::optional<Vec3>& position_m) noexcept {
  const CutStatus status = check(cloud, labels);
  if (status != CutStatus::ok) return status;

  place(cloud, position_m);
  fill_voxels(cloud);
  to_learn_ = true;
  if (window_.revolutions() == 0) {
    static_cast<void>(learn());
  } else {
    window_.look_up(revolution_);
  }
  write_labels(cloud, labels);
  return status;
}

bool RobustCut::learn(Learning learning, std::uint32_t window) noexcept {
  if (!std::exchange(to_learn_, false)) return false;
  const bool is_remembered =
      learning == Learning::later && window_.add_in_place(revolution_, pose_.position, window);
  if (is_remembered) return false;
  window_.add(revolution_, pose_.position, window);
  analyse();
  return true;
}

CutStatus RobustCut::check(const CloudView& cloud, std::span<Label> labels) const noexcept {
  if (cloud.size() > max_points()) return CutStatus::too_many_points;
  return check_cloud(cloud, labels.size()).status;
}

// As the last revolution went on; a step that is given is believed.
robust::RigPose RobustCut::predicted(const std::optional<Vec3>& position_m) const noexcept {
  robust::RigPose guess = pose_;
  if (position_m && given_position_m_) {
    guess.step = pose_.r_window_from_level * (*position_m - *given_position_m_).cast<float>();
  } else {
    guess.step *= kLasting;
  }
  if (guess.step.norm() < kStillM) guess.step.setZero();
  guess.position += guess.step;
  return guess;
}

void RobustCut::place(const CloudView& cloud, const std::optional<Vec3>& position_m) noexcept {
  const robust::RigPose guess = predicted(position_m);
  const bool known = position_m.has_value() && given_position_m_.has_value();
  std::optional<robust::RigPose> found;
  if (window_.revolutions() > 0 && !parameters_.align) found = guess;
  if (window_.revolutions() > 0 && parameters_.align) {
    const float position_sigma_m = kStepChangeM + (known ? 0.0F : pose_.step.norm());
    found = alignment_.find(cloud, model_, grids_, guess, position_sigma_m,
                            kLeastOfLastShare * structure_share_);
    if (found && !known) found->step = found->position - pose_.position;
  }
  if (found) {
    pose_ = *found;
  } else {
    forget();
    if (parameters_.upright) {
      fill_voxels(cloud);
      window_.add(revolution_, pose_.position, 1);
      const robust::Mat3f upright = robust::upright_correction(window_.map());
      pose_.r_window_from_level = robust::wall_correction(window_.map(), upright) * upright;
      window_.clear();
    }
  }
  given_position_m_ = position_m;
}

void RobustCut::fill_voxels(const CloudView& cloud) noexcept {
  points_ = cloud.size();
  revolution_.clear();
  robust::PlacedPoints placed;
  for (std::size_t begin = 0; begin < cloud.size(); begin += robust::kPointsAtOnce) {
    robust::place_points(cloud, begin, pose_, placed);
    const std::size_t count = std::min(robust::kPointsAtOnce, cloud.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t voxel =
          revolution_.find_or_add(robust::key_of({placed.x[i], placed.y[i], placed.z[i]}));
      voxel_of_point_[begin + i] = voxel;
      if (voxel == VoxelMap::kNone) continue;
      revolution_.voxels()[static_cast<std::size_t>(voxel)].moments.add_mm(
          placed.x_mm[i], placed.y_mm[i], placed.z_mm[i]);
    }
  }
}

void RobustCut::analyse() noexcept {
  take_surfels();
  find_structure();
  if (parameters_.mirrors && mirrors_.find(model_, grids_, window_.map())) find_structure();
  is_curved_ = {};
  if (parameters_.curved) {
    is_curved_ = curved_.find(model_, grids_, window_.map());
  }
  is_pillar_ = {};
  if (parameters_.pillars) {
    is_pillar_ = pillars_.find(model_, grids_, window_.map(), window_.origin());
  }
  recesses_.find(model_);
  grids_.mark_reach(model_);
}

void RobustCut::take_surfels() noexcept {
  model_.surfels.clear();
  for (const Voxel& voxel : window_.map().voxels()) {
    Surfel surfel;
    surfel.mean = voxel.mean();
    surfel.direction = voxel.direction;
    surfel.origin = window_.origin_of(voxel);
    surfel.points = voxel.moments.count;
    surfel.shape = voxel.shape;
    surfel.supported = is_supported(surfel, window_.revolutions(), points_);
    model_.surfels.push_back(surfel);
  }
}

void RobustCut::find_structure() noexcept {
  plane_search_.run(model_, window_.origin());
  robust::measure_spread(model_, window_.map().voxels());
  grids_.build(model_);
  flat_surfaces_.find(model_, grids_, window_.origin(), parameters_.free_space);
  walls_.find(model_, grids_, {window_.origin(), window_.revolutions()}, parameters_);
  if (parameters_.furniture) {
    robust::mark_backs(model_, grids_);
    robust::reject_what_is_behind(model_, grids_);
  }
  if (parameters_.fixtures) fixtures_.find(model_, grids_);
}

void RobustCut::take_near() noexcept {
  const std::span<const Voxel> voxels = revolution_.voxels();
  near_.resize(voxels.size());
  edges_.resize(1);
  const float reach_m = parameters_.band_m + kHalfDiagonal * robust::kVoxelM;
  robust::MovedPoints centres{};
  const std::uint64_t accepted = robust::accepted_planes(model_.planes);
  robust::PlaneSets planes;
  for (std::size_t begin = 0; begin < voxels.size(); begin += robust::kPointsAtOnce) {
    const std::size_t count = std::min(robust::kPointsAtOnce, voxels.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3f centre = robust::centre_of(robust::place_of(voxels[begin + i].key));
      centres.x[i] = centre.x();
      centres.y[i] = centre.y();
      centres.z[i] = centre.z();
    }
    robust::find_planes(centres.columns(), model_.planes, accepted, reach_m, planes);
    for (std::size_t i = 0; i < count; ++i) {
      near_[begin + i] =
          near_of(window_.merged(begin + i), {centres.x[i], centres.y[i], centres.z[i]}, planes[i]);
    }
  }
}

// in_window: the voxel, see Window::merged(). planes: within its reach.
RobustCut::Near RobustCut::near_of(std::int32_t in_window, const Vec3f& centre,
                                   std::uint64_t planes) noexcept {
  Near near;
  const auto merged = static_cast<std::size_t>(in_window);
  const bool known = is_known(in_window);
  if (known && model_.surfels[merged].mirrored) return near;
  const auto is_marked = [&](std::span<const std::uint8_t> marks) {
    return known && !marks.empty() && marks[merged] != 0;
  };
  near.unexplained = is_marked(is_curved_) || is_marked(is_pillar_);
  for (; planes != 0 && near.count < Near::kMost; planes &= planes - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(planes));
    NearPlane& plane = near.planes.at(near.count++);
    plane.plane = static_cast<std::uint8_t>(k);
    if (!known) {
      plane.goes_on = grids_.goes_on_to(k, centre);
    } else if (model_.planes[k].vertical) {
      plane.inset_m = grids_.inset_at(k, model_.surfels[merged].mean);
      plane.edge = edge_of(merged, k);
    }
  }
  if (known) {
    near.recess = recesses_.recess_of(model_, grids_, model_.surfels[merged], parameters_.band_m);
  }
  return near;
}

// As an index into edges_. 0: no layer is near, or there is no room for another edge.
std::uint16_t RobustCut::edge_of(std::size_t in_window, std::size_t plane) noexcept {
  if (!parameters_.fixtures || edges_.size() == edges_.capacity()) return 0;
  const auto edge = robust::LayerEdge::of(model_, grids_, window_.map(), in_window, plane);
  if (!edge) return 0;
  edges_.push_back(*edge);
  return static_cast<std::uint16_t>(edges_.size() - 1);
}

bool RobustCut::is_structure(const Vec3f& p, std::int32_t voxel) const noexcept {
  if (voxel == VoxelMap::kNone) return false;
  const Near& near = near_[static_cast<std::size_t>(voxel)];
  const float behind_m = std::max(parameters_.band_m, kBehindM);
  for (std::size_t i = 0; i < near.count; ++i) {
    const NearPlane& plane = near.planes.at(i);
    const float height_m = model_.planes[plane.plane].height_of(p) - plane.inset_m;
    if (height_m > parameters_.band_m || height_m < -behind_m) continue;
    if (plane.edge != 0 && edges_[plane.edge].is_on_layer(p)) continue;
    if (plane.goes_on || grids_.is_within_reach(plane.plane, p)) return true;
  }
  return near.unexplained || (near.recess != robust::Recesses::kNone &&
                              recesses_.holds(model_, near.recess, p, parameters_.band_m));
}

void RobustCut::write_labels(const CloudView& cloud, std::span<Label> labels) noexcept {
  take_near();
  label_points(cloud, labels);
  if (parameters_.steady && judge_voxels()) steady(cloud, labels);
}

void RobustCut::label_points(const CloudView& cloud, std::span<Label> labels) noexcept {
  std::size_t structure = 0;
  robust::MovedPoints moved;
  for (std::size_t begin = 0; begin < cloud.size(); begin += robust::kPointsAtOnce) {
    robust::move_points(cloud, begin, pose_, moved);
    for (std::size_t i = 0; i < std::min(robust::kPointsAtOnce, cloud.size() - begin); ++i) {
      const Vec3f p(moved.x[i], moved.y[i], moved.z[i]);
      const std::int32_t voxel = voxel_of_point_[begin + i];
      const bool is = is_structure(p, voxel);
      labels[begin + i] = is ? Label::structure : Label::other;
      if (!is) continue;
      ++near_[static_cast<std::size_t>(voxel)].structure;
      ++structure;
    }
  }
  structure_share_ =
      static_cast<float>(structure) / static_cast<float>(std::max<std::size_t>(cloud.size(), 1));
}

// Whether any is taken for something else than this revolution says.
bool RobustCut::judge_voxels() noexcept {
  bool any = false;
  for (std::size_t i = 0; i < near_.size(); ++i) {
    Near& near = near_[i];
    const Voxel& voxel = revolution_.voxels()[i];
    near.verdict = window_.judge(i, voxel.key, 2 * near.structure > voxel.moments.count);
    any |= near.verdict != robust::Verdict::as_now;
  }
  return any;
}

void RobustCut::steady(const CloudView& cloud, std::span<Label> labels) const noexcept {
  robust::MovedPoints moved;
  for (std::size_t begin = 0; begin < cloud.size(); begin += robust::kPointsAtOnce) {
    robust::move_points(cloud, begin, pose_, moved);
    for (std::size_t i = 0; i < std::min(robust::kPointsAtOnce, cloud.size() - begin); ++i) {
      const std::int32_t in_revolution = voxel_of_point_[begin + i];
      if (in_revolution == VoxelMap::kNone) continue;
      const auto voxel = static_cast<std::size_t>(in_revolution);
      const robust::Verdict verdict = near_[voxel].verdict;
      if (verdict == robust::Verdict::object) labels[begin + i] = Label::other;
      if (is_restored(verdict, {moved.x[i], moved.y[i], moved.z[i]}, voxel)) {
        labels[begin + i] = Label::structure;
      }
    }
  }
}

// Whether the point is structure by what was decided of its voxel in earlier revolutions: on the
// window's piece of surface there; anywhere, where that is not known yet of a place that is back.
bool RobustCut::is_restored(robust::Verdict verdict, const Vec3f& p,
                            std::size_t voxel) const noexcept {
  const bool is_back = verdict == robust::Verdict::structure_again;
  if (verdict != robust::Verdict::structure && !is_back) return false;
  const std::int32_t merged = window_.merged(voxel);
  if (!is_known(merged)) return is_back;
  const Surfel& surfel = model_.surfels[static_cast<std::size_t>(merged)];
  if (surfel.mirrored) return false;
  const bool has_surface =
      is_back ? has_normal(surfel.shape) : surfel.shape == robust::Shape::plane;
  if (!has_surface) return is_back;
  return std::abs(surfel.direction.dot(p - surfel.mean)) <= parameters_.band_m;
}

}  // namespace convexcut
