// SPDX-License-Identifier: Apache-2.0
#include "core/scan/orientation_track.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace convexcut {

OrientationTrack::OrientationTrack(std::size_t capacity, Duration max_age)
    : samples_(capacity), max_age_(max_age) {
  if (capacity == 0) throw std::invalid_argument("an orientation track needs a capacity");
  if (max_age < Duration::zero()) throw std::invalid_argument("max_age must not be negative");
}

bool OrientationTrack::push(HostTime time, const Quaternion& rotation) noexcept {
  const double norm = rotation.norm();
  constexpr double kNoLength = 1e-6;
  // Written so that a norm that is not a number is refused too.
  const bool usable = norm > kNoLength && std::isfinite(norm);
  const bool newer = begin_ == end_ || time > sample(end_ - 1).time;
  if (!usable || !newer) {
    ++refused_;
    return false;
  }
  if (size() == samples_.size()) ++begin_;
  Sample& slot = samples_[end_ % samples_.size()];
  slot.time = time;
  slot.rotation.coeffs() = rotation.coeffs() / norm;
  ++end_;
  return true;
}

Orientation OrientationTrack::at(HostTime time) const noexcept {
  if (begin_ == end_ || time < sample(begin_).time) return {};
  const std::uint64_t number = last_not_after(time);
  const Sample& before = sample(number);
  const Duration age = time - before.time;
  if (age == Duration::zero()) return {before.rotation, OrientationQuality::interpolated};
  if (number + 1 < end_) {
    const Sample& after = sample(number + 1);
    const Duration gap = after.time - before.time;
    if (gap <= max_age_) {
      const double share = static_cast<double>(age.count()) / static_cast<double>(gap.count());
      return {before.rotation.slerp(share, after.rotation), OrientationQuality::interpolated};
    }
  }
  if (age <= max_age_) return {before.rotation, OrientationQuality::held};
  return {};
}

std::optional<HostTime> OrientationTrack::newest() const noexcept {
  if (begin_ == end_) return std::nullopt;
  return sample(end_ - 1).time;
}

std::uint64_t OrientationTrack::last_not_after(HostTime time) const noexcept {
  const auto holds = [&](std::uint64_t number) {
    return number >= begin_ && number < end_ && sample(number).time <= time &&
           (number + 1 == end_ || time < sample(number + 1).time);
  };
  if (holds(cursor_)) return cursor_;
  if (holds(cursor_ + 1)) return ++cursor_;

  std::uint64_t low = begin_;  // at or before `time`
  std::uint64_t high = end_;   // after it
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    (sample(middle).time <= time ? low : high) = middle;
  }
  cursor_ = low;
  return low;
}

}  // namespace convexcut
