// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/angle.hpp"
#include "core/geometry.hpp"
#include "core/time.hpp"

namespace convexcut::simulation {

// What follows the last way point: to the first one again, the whole way back, nothing.
enum class PathEnd : std::uint8_t { loop, back, stop };

// Where something on a path is, and how it got there.
struct PathPoint {
  Vec3 position = Vec3::Zero();
  Radians heading;           // of the movement in the x-y plane, from x to y
  double travelled_m = 0.0;  // along the path since its start
  bool moving = false;
};

// A way along straight lines between way points at one speed, with a pause at each of them.
// Deterministic in time: any order of calls gives the same places.
class Path {
 public:
  Path() = default;
  // At least one way point; speed > 0 (m/s); pause ≥ 0. The way begins `start_m` along the path.
  Path(std::vector<Vec3> way_points, double speed_m_s, PathEnd end, Duration pause = {},
       double start_m = 0.0);

  [[nodiscard]] bool empty() const noexcept { return way_points_.empty(); }
  [[nodiscard]] const std::vector<Vec3>& way_points() const noexcept { return way_points_; }
  [[nodiscard]] double speed_m_s() const noexcept { return speed_m_s_; }
  [[nodiscard]] PathEnd end() const noexcept { return end_; }

  // Without allocation. The path must not be empty. Times < 0 count as 0.
  [[nodiscard]] PathPoint at(Duration since_start) const noexcept;

 private:
  void skip(double start_m) noexcept;

  struct Leg {
    Vec3 from;
    Vec3 direction;  // unit
    Radians heading;
    double start_s = 0.0;  // when it begins, since the round began
    double length_m = 0.0;
    double start_m = 0.0;
  };

  std::vector<Vec3> way_points_;
  std::vector<Leg> legs_;  // of one round
  double speed_m_s_ = 1.0;
  double pause_s_ = 0.0;
  double round_s_ = 0.0;
  double round_m_ = 0.0;
  double start_s_ = 0.0;
  PathEnd end_ = PathEnd::loop;
};

}  // namespace convexcut::simulation
