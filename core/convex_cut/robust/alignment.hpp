// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "core/cloud.hpp"
#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/pose.hpp"
#include "core/workspace.hpp"

namespace convexcut::robust {

// Lays a revolution on the planes that are known.
class Alignment {
 public:
  Alignment();

  // Moves a pose so that the cloud lies on the model's planes, structure or not, by least squares
  // of the points' distances; where the planes do not hold it, it stays. position_sigma_m: how far
  // the guess may be off. None: less than `least_share` of the cloud's points lie on structure. RT:
  // no allocation, no lock, no system call.
  [[nodiscard]] std::optional<RigPose> find(const CloudView& cloud, const Model& model,
                                            const PlaneGrids& grids, const RigPose& guess,
                                            float position_sigma_m, float least_share) noexcept;

 private:
  struct Equations;
  void take_samples(const CloudView& cloud) noexcept;
  [[nodiscard]] Equations equations_at(const RigPose& pose, const Model& model,
                                       const PlaneGrids& grids, float gate_m) const noexcept;

  Workspace<float> x_, y_, z_, from_middle_;  // of the samples
  std::size_t samples_ = 0;
};

}  // namespace convexcut::robust
