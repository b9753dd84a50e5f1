// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "core/clock/clock_mapping.hpp"
#include "core/imu_sample.hpp"
#include "core/ring/spsc_ring.hpp"
#include "daemon/dds/publisher.hpp"

namespace convexcut::daemon {

// Writes every IMU sample as it comes. A thread of its own, not a realtime one, so that a slow
// reader of clouds does not delay it.
class ImuPublishing {
 public:
  ImuPublishing(const Participant& participant, const config::Dds& settings,
                SpscRing<ImuSample>& samples)
      : publisher_(participant, settings), samples_(samples) {}

  // The thread's body: returns on stop, or when `input_ended` is set and the ring is empty.
  void run(const std::atomic<bool>& stop, const std::atomic<bool>& input_ended);

 private:
  void publish(const ImuSample& sample);

  ImuPublisher publisher_;
  SpscRing<ImuSample>& samples_;
  ClockMapping<ImuTime> clock_;
  HostTime newest_arrival_{};
};

}  // namespace convexcut::daemon
