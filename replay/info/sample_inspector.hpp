// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/clock/clock_mapping.hpp"
#include "core/imu_sample.hpp"
#include "core/sink.hpp"
#include "replay/info/info_text.hpp"

namespace convexcut::replay {

// Follows an IMU's samples.
class SampleInspector final : public Sink<ImuSample> {
 public:
  [[nodiscard]] ImuSample* claim() noexcept override { return &sample_; }
  void commit() noexcept override {
    ++samples_;
    orientations_ += sample_.has_orientation ? 1 : 0;
    first_ = std::min(first_, sample_.arrival);
    last_ = std::max(last_, sample_.arrival);
    if (sample_.has_device_time) clock_.observe(sample_.device_time, sample_.arrival);
  }
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::uint64_t orientations() const { return orientations_; }
  [[nodiscard]] HostTime first() const { return first_; }
  [[nodiscard]] Duration duration() const {
    return samples_ > 0 ? last_ - first_ : Duration::zero();
  }
  [[nodiscard]] double rate_hz() const {
    return samples_ > 1 ? per_second(samples_ - 1, duration()) : 0.0;
  }
  [[nodiscard]] ClockState clock() const { return clock_.state(); }

 private:
  ImuSample sample_;
  std::uint64_t samples_ = 0;
  std::uint64_t orientations_ = 0;
  HostTime first_ = HostTime::max();
  HostTime last_ = HostTime::min();
  ClockMapping<ImuTime> clock_;
};

}  // namespace convexcut::replay
