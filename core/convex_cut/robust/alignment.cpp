// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/alignment.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/convex_cut/robust/point_kernels.hpp"

namespace convexcut::robust {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kSamples = 6'000;  // at least, where there are so many points
constexpr std::array<float, 5> kGatesM{0.25F, 0.15F, 0.10F, 0.07F, 0.07F};
constexpr double kNoiseM = 0.02;
// Neighbouring points share what is wrong with their surface: their information adds up slowly.
constexpr double kIndependent = 0.05;
constexpr double kRotationSigma = 0.01;  // radians
constexpr float kOffFaceM = 0.01F;       // of a cell's mean: something before or behind the face
constexpr float kOfUnknown = 0.3F;       // share of a point's weight where a plane is hardly known

// What stands holds the pose whether it is structure or not, but no rings of the lidar.
[[nodiscard]] std::uint64_t surfaces(const Model& model) noexcept {
  std::uint64_t set = 0;
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Plane& plane = model.planes[k];
    set |= std::uint64_t{plane.accepted || !plane.edge_on ? 1U : 0U} << k;
  }
  return set;
}

// Where a point touches a surface.
struct Touch {
  const Plane* plane = nullptr;  // none: nowhere
  const Cell* cell = nullptr;    // none: outside of what was seen of the plane
  float height_m = 0.0F;         // over the plane
};

// Of the planes that p is near, the nearest that was seen there.
[[nodiscard]] Touch touch_of(const Model& model, const PlaneGrids& grids, const Vec3f& p,
                             std::uint64_t near, float gate_m) noexcept {
  Touch touch;
  float least = gate_m;
  for (; near != 0; near &= near - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(near));
    const Plane& plane = model.planes[k];
    const float height_m = plane.height_of(p);
    if (std::abs(height_m) >= least) continue;
    const PlaneGrid& grid = grids.grid(k);
    const std::int32_t column = grid.column_of(p);
    const std::int32_t row = grid.row_of(p);
    const Cell* cell = grid.holds(column, row) ? &grids.cell(grid, column, row) : nullptr;
    const bool is_there = plane.accepted ? grids.is_beside_structure(k, column, row)
                                         : cell != nullptr && cell->seen > 0;
    if (!is_there) continue;
    least = std::abs(height_m);
    touch = {&plane, cell, height_m};
  }
  return touch;
}

struct Expected {
  float height_m = 0.0F;  // over the plane
  float share = 1.0F;     // of a point's weight
};

// Where the plane's surface is. A board, a door or the books in a front are where they were seen:
// taken for the plane itself they draw the pose by as much as they are off it, more or less as more
// or less of them is in view.
[[nodiscard]] Expected expected_at(const Touch& touch) noexcept {
  if (touch.cell == nullptr || !touch.cell->tells_depth()) return {0.0F, kOfUnknown};
  const float mean_m = touch.cell->mean_m();
  const float face_m = touch.plane->face_m;
  return {std::abs(mean_m - face_m) > kOffFaceM ? mean_m : face_m, 1.0F};
}

}  // namespace

struct Alignment::Equations {
  Mat6 information = Mat6::Zero();  // its lower triangle
  Vec6 gradient = Vec6::Zero();
  std::size_t structure = 0;  // points on it

  // height_m: over where it is expected.
  void add(const Vec3f& from_rig, const Plane& plane, float height_m, float share) noexcept {
    Vec6 j;
    j << from_rig.cross(plane.normal).cast<double>(), plane.normal.cast<double>();
    const auto height = static_cast<double>(height_m);
    const double relative = height / kNoiseM;
    const double weight = static_cast<double>(share) * kIndependent / (kNoiseM * kNoiseM) /
                          (1.0 + relative * relative / 4.0);
    for (Eigen::Index column = 0; column < 6; ++column) {
      for (Eigen::Index row = column; row < 6; ++row) {
        information(row, column) += weight * j[row] * j[column];
      }
    }
    gradient += weight * height * j;
    structure += plane.accepted ? 1U : 0U;
  }
};

Alignment::Alignment() {
  for (Workspace<float>* column : {&x_, &y_, &z_, &from_middle_}) {
    column->resize(2 * kSamples + kPointsAtOnce);
  }
}

void Alignment::take_samples(const CloudView& cloud) noexcept {
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / kSamples);
  samples_ = 0;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    x_[samples_] = cloud.x[i];
    y_[samples_] = cloud.y[i];
    z_[samples_] = cloud.z[i];
    const float share = static_cast<float>(i) / static_cast<float>(cloud.size());
    from_middle_[samples_++] = share - 0.5F;
  }
}

Alignment::Equations Alignment::equations_at(const RigPose& pose, const Model& model,
                                             const PlaneGrids& grids, float gate_m) const noexcept {
  Equations equations;
  MovedPoints moved;
  const std::uint64_t asked = surfaces(model);
  PlaneSets near;
  for (std::size_t begin = 0; begin < samples_; begin += kPointsAtOnce) {
    move_points({&x_[begin], &y_[begin], &z_[begin]}, &from_middle_[begin], pose, moved);
    find_planes(moved.columns(), model.planes, asked, gate_m, near);
    for (std::size_t i = 0; i < std::min(kPointsAtOnce, samples_ - begin); ++i) {
      const Vec3f p(moved.x[i], moved.y[i], moved.z[i]);
      const Touch touch = touch_of(model, grids, p, near[i], gate_m);
      if (touch.plane == nullptr) continue;
      const Expected expected = expected_at(touch);
      equations.add(p - pose.position, *touch.plane, touch.height_m - expected.height_m,
                    expected.share);
    }
  }
  return equations;
}

std::optional<RigPose> Alignment::find(const CloudView& cloud, const Model& model,
                                       const PlaneGrids& grids, const RigPose& guess,
                                       float position_sigma_m, float least_share) noexcept {
  take_samples(cloud);
  const auto position_sigma = static_cast<double>(position_sigma_m);
  Vec6 prior;
  prior << Vec3::Constant(1.0 / (kRotationSigma * kRotationSigma)),
      Vec3::Constant(1.0 / (position_sigma * position_sigma));
  RigPose pose = guess;
  Vec6 moved = Vec6::Zero();
  std::size_t fitting = 0;
  for (const float gate_m : kGatesM) {
    Equations equations = equations_at(pose, model, grids, gate_m);
    fitting = equations.structure;
    equations.information.diagonal() += prior;
    equations.gradient += prior.cwiseProduct(moved);
    const Vec6 step = -equations.information.ldlt().solve(equations.gradient);
    moved += step;
    const Vec3f turn = step.head<3>().cast<float>();
    pose.r_window_from_level =
        Eigen::AngleAxisf(turn.norm(), turn.stableNormalized()).toRotationMatrix() *
        pose.r_window_from_level;
    pose.position += step.tail<3>().cast<float>();
  }
  if (static_cast<float>(fitting) < least_share * static_cast<float>(samples_)) return std::nullopt;
  return pose;
}

}  // namespace convexcut::robust
