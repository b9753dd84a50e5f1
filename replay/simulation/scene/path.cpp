// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/path.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace convexcut::simulation {

Path::Path(std::vector<Vec3> way_points, double speed_m_s, PathEnd end, Duration pause,
           double start_m)
    : way_points_(std::move(way_points)),
      speed_m_s_(speed_m_s),
      pause_s_(std::chrono::duration<double>(pause).count()),
      end_(end) {
  std::vector<Vec3> round = way_points_;
  if (end == PathEnd::loop) round.push_back(way_points_.front());
  if (end == PathEnd::back) {
    round.insert(round.end(), std::next(way_points_.rbegin()), way_points_.rend());
  }
  for (std::size_t i = 0; i + 1 < round.size(); ++i) {
    const Vec3 way = round[i + 1] - round[i];
    const double length = way.norm();
    if (length <= 0.0) continue;
    legs_.push_back(
        {round[i], way / length, {std::atan2(way.y(), way.x())}, round_s_, length, round_m_});
    round_s_ += pause_s_ + length / speed_m_s_;
    round_m_ += length;
  }
  skip(start_m);
}

// The time at which `start_m` has been travelled, of the round in which that is.
void Path::skip(double start_m) noexcept {
  if (legs_.empty()) return;
  double rest = std::max(start_m, 0.0);
  if (end_ != PathEnd::stop) rest = std::fmod(rest, round_m_);
  const auto after = std::ranges::upper_bound(legs_, rest, {}, &Leg::start_m);
  const Leg& leg = *std::prev(after);
  start_s_ =
      leg.start_s + (rest > leg.start_m ? pause_s_ : 0.0) + (rest - leg.start_m) / speed_m_s_;
}

PathPoint Path::at(Duration since_start) const noexcept {
  if (legs_.empty()) return {way_points_.front(), {}, 0.0, false};
  double time_s = start_s_ + std::max(std::chrono::duration<double>(since_start).count(), 0.0);
  double travelled = 0.0;
  if (end_ != PathEnd::stop) {
    const double rounds = std::floor(time_s / round_s_);
    time_s -= rounds * round_s_;
    travelled = rounds * round_m_;
  }
  const auto after = std::ranges::upper_bound(legs_, time_s, {}, &Leg::start_s);
  const Leg& leg = after == legs_.begin() ? *after : *std::prev(after);
  // The pause is at the way point where the leg begins.
  const double on_leg = (time_s - leg.start_s - pause_s_) * speed_m_s_;
  const double done = std::clamp(on_leg, 0.0, leg.length_m);
  return {leg.from + done * leg.direction, leg.heading, travelled + leg.start_m + done,
          on_leg > 0.0 && on_leg < leg.length_m};
}

}  // namespace convexcut::simulation
