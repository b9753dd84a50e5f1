// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/imu_sample.hpp"
#include "core/sink.hpp"

namespace convexcut::recording {

// Passes samples on and remembers what they were. One thread.
class SampleTap final : public Sink<ImuSample> {
 public:
  explicit SampleTap(Sink<ImuSample>& to) noexcept : to_(to) {}

  [[nodiscard]] ImuSample* claim() noexcept override { return claimed_ = to_.claim(); }
  void commit() noexcept override {
    ++samples_;
    if (claimed_->has_orientation) ++orientations_;
    to_.commit();
  }

  [[nodiscard]] std::uint64_t samples() const noexcept { return samples_; }
  [[nodiscard]] std::uint64_t orientations() const noexcept { return orientations_; }

 private:
  Sink<ImuSample>& to_;
  ImuSample* claimed_ = nullptr;
  std::uint64_t samples_ = 0;
  std::uint64_t orientations_ = 0;
};

}  // namespace convexcut::recording
