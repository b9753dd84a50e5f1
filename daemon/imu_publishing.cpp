// SPDX-License-Identifier: Apache-2.0
#include "daemon/imu_publishing.hpp"

#include <chrono>

namespace convexcut::daemon {
namespace {

// The stop flag is looked at this often.
constexpr Duration kLongestSampleWait = std::chrono::milliseconds{50};

// No IMU is silent for so long, or goes back so far: the host's clock was set, or the device was
// away. The mapping would notice, but seconds later.
constexpr Duration kLeap = std::chrono::seconds{1};

}  // namespace

void ImuPublishing::run(const std::atomic<bool>& stop, const std::atomic<bool>& input_ended) {
  // Relaxed: the flag only ends the loop, it publishes nothing.
  while (!stop.load(std::memory_order_relaxed)) {
    // Before looking into the ring. Acquire: pairs with the release store after the source's last
    // commit, so that an empty ring then stays empty.
    const bool ended = input_ended.load(std::memory_order_acquire);
    const ImuSample* sample = samples_.front();
    if (sample != nullptr) {
      publish(*sample);
      samples_.pop();
    } else if (ended) {
      return;
    } else {
      filled_.wait(kLongestSampleWait);
    }
  }
}

void ImuPublishing::publish(const ImuSample& sample) {
  HostTime stamp = sample.arrival;
  if (std::chrono::abs(sample.arrival - newest_arrival_) > kLeap) clock_.reset();
  newest_arrival_ = sample.arrival;
  if (sample.has_device_time) {
    clock_.observe(sample.device_time, sample.arrival);
    stamp = clock_.to_host(sample.device_time);
  }
  publisher_.publish(sample, stamp);
}

}  // namespace convexcut::daemon
