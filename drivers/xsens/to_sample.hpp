// SPDX-License-Identifier: Apache-2.0
//
// Measurement → ImuSample: what serial and CAN have in common.
#pragma once

#include "core/counter.hpp"
#include "core/imu_sample.hpp"
#include "drivers/xsens/mt_measurement.hpp"

namespace convexcut::xsens {

struct ValueCounters {
  Counter invalid_orientations;  // the numbers are no rotation: sent on without orientation
  Counter invalid_vectors;       // rate of turn or acceleration not finite: sent on without it
};

// A measurement makes a sample when it holds orientation, rate of turn or acceleration.
[[nodiscard]] bool makes_sample(const MtMeasurement& m) noexcept;

// Fills all of `sample` but its times, which depend on the transport. Rate of turn and acceleration
// come from the high-rate items where the ordinary ones are absent; status is the status word, else
// the status byte. RT.
void fill_sample(const MtMeasurement& m, ImuSample& sample, ValueCounters& counters) noexcept;

}  // namespace convexcut::xsens
