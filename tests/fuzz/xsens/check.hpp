// SPDX-License-Identifier: Apache-2.0
//
// What holds for every sample, whatever came in.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/imu_sample.hpp"
#include "core/sink.hpp"

namespace convexcut::fuzz {

inline void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "violated: %s\n", what);
  std::abort();
}

// Checks samples and sums them up, so that two runs can be compared.
class CheckingSink : public Sink<ImuSample> {
 public:
  ImuSample* claim() noexcept override { return &slot_; }
  void commit() noexcept override {
    require(slot_.q_level_from_imu.coeffs().allFinite(), "orientation is finite");
    require(std::abs(slot_.q_level_from_imu.norm() - 1) < 1e-9, "orientation has unit length");
    require(slot_.angular_velocity_rad_s.allFinite(), "angular velocity is finite");
    require(slot_.acceleration_m_s2.allFinite(), "acceleration is finite");
    ++count_;
    const auto add = [this](std::uint64_t value) {
      digest_ = (digest_ ^ value) * 0x100000001B3ULL;
    };
    add(slot_.counter);
    add(slot_.status);
    add(static_cast<std::uint64_t>(to_ns(slot_.device_time)));
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::uint64_t digest() const { return digest_; }

 private:
  ImuSample slot_;
  std::uint64_t count_ = 0;
  std::uint64_t digest_ = 0xCBF29CE484222325ULL;
};

}  // namespace convexcut::fuzz
