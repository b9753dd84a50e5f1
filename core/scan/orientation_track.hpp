// SPDX-License-Identifier: Apache-2.0
//
// Recent orientations, to be asked for the orientation at any instant of them: rotations imu →
// level of an IMU, lidar → base of a turning stage.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry.hpp"
#include "core/time.hpp"

namespace convexcut {

enum class OrientationQuality : std::uint8_t {
  interpolated,  // between two samples that are at most max_age apart (or exactly on one)
  held,          // that of the sample before, at most max_age old: the next is missing or too far
  missing,       // no sample is near enough before; the orientation is not to be used
};

struct Orientation {
  Quaternion rotation = Quaternion::Identity();
  OrientationQuality quality = OrientationQuality::missing;
};

// Holds the newest `capacity` samples. Nothing is extrapolated: an orientation is interpolated,
// held for at most max_age, or missing.
//
// One thread (also at() moves an internal cursor, which makes queries in the order of time O(1)).
// RT after construction: no allocation, no lock, no system call.
class OrientationTrack {
 public:
  // Throws std::invalid_argument when capacity is 0 or max_age negative.
  explicit OrientationTrack(std::size_t capacity, Duration max_age = std::chrono::milliseconds{50});

  // Refuses, and counts, what is not newer than newest(), not finite or of no length. When the
  // host's clock has been set back (ClockState::steps), clear() first.
  bool push(HostTime time, const Quaternion& rotation) noexcept;

  // Along the shortest rotation between the neighbours (slerp).
  [[nodiscard]] Orientation at(HostTime time) const noexcept;

  [[nodiscard]] std::optional<HostTime> newest() const noexcept;
  [[nodiscard]] std::size_t size() const noexcept {
    return static_cast<std::size_t>(end_ - begin_);
  }
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }
  void clear() noexcept {
    begin_ = end_;
    turn_ = {};
  }

 private:
  struct Sample {
    HostTime time;
    Quaternion rotation;
  };

  // Samples are numbered from 0 as they come; those of [begin_, end_) are held.
  [[nodiscard]] const Sample& sample(std::uint64_t number) const noexcept {
    return samples_[number % samples_.size()];
  }
  // The number of the last sample at or before `time`, which is not before the oldest.
  [[nodiscard]] std::uint64_t last_not_after(HostTime time) const noexcept;

  // From one sample to the next, which are at most max_age apart: the rotation between them, the
  // short way, is one about a unit axis of the first one's frame by 2·half_angle. Found once for
  // all queries between them.
  struct Turn {
    HostTime begin{};
    HostTime end{};  // not after `begin`: none
    Quaternion from = Quaternion::Identity();
    Vec3 axis = Vec3::Zero();
    double half_angle_per_ns = 0.0;

    [[nodiscard]] bool covers(HostTime time) const noexcept { return time >= begin && time < end; }
    [[nodiscard]] Quaternion at(HostTime time) const noexcept;
  };
  [[nodiscard]] static Turn turn_between(const Sample& from, const Sample& to) noexcept;

  std::vector<Sample> samples_;
  Duration max_age_;
  std::uint64_t begin_ = 0;
  std::uint64_t end_ = 0;
  std::uint64_t refused_ = 0;
  mutable std::uint64_t cursor_ = 0;
  mutable Turn turn_;
};

}  // namespace convexcut
