// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/rig/rig_path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace convexcut::simulation {

RigPath::RigPath(std::vector<Vec3> way_points, double speed_m_s, PathEnd end)
    : points_(std::move(way_points)), end_(end) {
  if (points_.empty()) throw std::invalid_argument("a path without way points");
  if (!(speed_m_s > 0.0)) throw std::invalid_argument("the speed on a path is not above 0");
  if (end_ == PathEnd::loop && points_.size() > 1 && points_.front() != points_.back()) {
    points_.push_back(points_.front());
  }
  times_.assign(1, 0.0);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const double length = (points_[i] - points_[i - 1]).norm();
    if (!(length > 0.0)) throw std::invalid_argument("two equal way points in a row");
    // A cubic from rest to a steady speed is half as long on its way as the speed has it.
    const double stretch = i == 1 || i + 1 == points_.size() ? 1.5 : 1.0;
    times_.push_back(times_.back() + stretch * length / speed_m_s);
  }
  solve_velocities();
}

// Continuous acceleration at every inner knot, with velocity 0 at both ends: one tridiagonal system
// (C. de Boor, "A Practical Guide to Splines", IV), solved from front to back.
void RigPath::solve_velocities() {
  const std::size_t n = points_.size();
  velocities_.assign(n, Vec3::Zero());
  if (n < 3) return;
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = times_[i] - times_[i - 1];
    const double after = times_[i + 1] - times_[i];
    const Vec3 right = 3.0 * (after / before * (points_[i] - points_[i - 1]) +
                              before / after * (points_[i + 1] - points_[i]));
    const double pivot = 2.0 * (before + after) - after * upper[i - 1];
    upper[i] = before / pivot;
    velocities_[i] = (right - after * velocities_[i - 1]) / pivot;
  }
  for (std::size_t i = n - 2; i > 0; --i) velocities_[i] -= upper[i] * velocities_[i + 1];
}

Travel RigPath::at(Duration since_start) const noexcept {
  const double round = times_.back();
  double t = std::max(std::chrono::duration<double>(since_start).count(), 0.0);
  if (round <= 0.0) return {points_.front(), Vec3::Zero(), Vec3::Zero()};
  switch (end_) {
    case PathEnd::stop:
      return on_round(std::min(t, round));
    case PathEnd::loop:
      return on_round(std::fmod(t, round));
    case PathEnd::back:
      break;
  }
  t = std::fmod(t, 2.0 * round);
  if (t <= round) return on_round(t);
  Travel back = on_round(2.0 * round - t);
  back.velocity_m_s = -back.velocity_m_s;
  return back;
}

// The cubic Hermite polynomial of the stretch.
Travel RigPath::on_round(double seconds) const noexcept {
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, seconds);
  const auto i = static_cast<std::size_t>(after - times_.begin());
  const double h = times_[i] - times_[i - 1];
  const double s = (seconds - times_[i - 1]) / h;
  const Vec3 step = points_[i] - points_[i - 1];
  const Vec3 from = h * velocities_[i - 1];
  const Vec3 to = h * velocities_[i];
  const Vec3 quadratic = 3.0 * step - 2.0 * from - to;
  const Vec3 cubic = from + to - 2.0 * step;
  return {points_[i - 1] + s * (from + s * (quadratic + s * cubic)),
          (from + s * (2.0 * quadratic + 3.0 * s * cubic)) / h,
          (2.0 * quadratic + 6.0 * s * cubic) / (h * h)};
}

}  // namespace convexcut::simulation
