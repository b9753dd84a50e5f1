// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry.hpp"
#include "core/time.hpp"
#include "replay/simulation/scene/path.hpp"

namespace convexcut::simulation {

// Where a rig on its way is, and how it moves.
struct Travel {
  Vec3 position_m = Vec3::Zero();
  Vec3 velocity_m_s = Vec3::Zero();
  Vec3 acceleration_m_s2 = Vec3::Zero();
};

// A smooth way through way points: a cubic spline in time whose knots are as far apart as the
// speed makes the straight lines between them. Position and velocity are smooth everywhere,
// acceleration is continuous; it starts and ends at rest, also where it turns back. Between way
// points the spline may leave the straight line to the outside of a bend.
class RigPath {
 public:
  // Stands at the origin for ever.
  RigPath() : RigPath({Vec3::Zero()}, 1.0, PathEnd::stop) {}
  // At least one way point, no two equal ones in a row; speed > 0, m/s: what is kept up between the
  // first and the last stretch, which take half as long again. Throws std::invalid_argument.
  RigPath(std::vector<Vec3> way_points, double speed_m_s, PathEnd end);

  // Times < 0 count as 0.
  [[nodiscard]] Travel at(Duration since_start) const noexcept;

 private:
  void solve_velocities();
  [[nodiscard]] Travel on_round(double seconds) const noexcept;

  std::vector<Vec3> points_;
  std::vector<Vec3> velocities_;  // at the points
  std::vector<double> times_;     // of the points, s; ascending from 0
  PathEnd end_;
};

}  // namespace convexcut::simulation
