// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/imu_sample.hpp"
#include "core/sink.hpp"

namespace convexcut::test {

// Keeps what a driver commits. Its slot is dirty before each claim, as a ring's is.
class RecordingSink : public Sink<ImuSample> {
 public:
  explicit RecordingSink(std::size_t capacity = std::numeric_limits<std::size_t>::max())
      : capacity_(capacity) {}

  ImuSample* claim() noexcept override {
    slot_.status = 0xDEADBEEF;
    slot_.counter = 0xDEAD;
    slot_.has_orientation = slot_.has_angular_velocity = slot_.has_acceleration = true;
    slot_.has_status = slot_.has_counter = slot_.has_device_time = true;
    slot_.acceleration_m_s2 = Vec3f(7, 7, 7);
    return samples.size() < capacity_ ? &slot_ : nullptr;
  }
  void commit() noexcept override { samples.push_back(slot_); }

  std::vector<ImuSample> samples;

 private:
  ImuSample slot_;
  std::size_t capacity_;
};

}  // namespace convexcut::test
