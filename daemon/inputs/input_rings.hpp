// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/encoder_sample.hpp"
#include "core/imu_sample.hpp"
#include "core/return_batch.hpp"
#include "core/ring/ring_sink.hpp"
#include "core/ring/spsc_ring.hpp"
#include "core/sink.hpp"
#include "daemon/health/stages.hpp"
#include "daemon/wake_up.hpp"
#include "drivers/live/host_clock.hpp"

namespace convexcut::daemon {

// Where an IMU driver puts its samples in the daemon: into the worker's ring, and a copy into the
// publisher's, whom it wakes. The driver's thread.
class ImuTee final : public Sink<ImuSample> {
 public:
  ImuTee(SpscRing<ImuSample>& worker, SpscRing<ImuSample>& publisher, WakeUp& filled) noexcept
      : worker_(worker), publisher_(publisher), filled_(filled) {}

  [[nodiscard]] ImuSample* claim() noexcept override { return claimed_ = worker_.claim(); }
  void commit() noexcept override {
    if (ImuSample* copy = publisher_.claim()) {
      *copy = *claimed_;
      publisher_.commit();
      filled_.notify();
    }
    worker_.commit();
  }

 private:
  SpscRing<ImuSample>& worker_;
  SpscRing<ImuSample>& publisher_;
  WakeUp& filled_;
  ImuSample* claimed_ = nullptr;
};

// Where a lidar driver puts its batches: into the worker's ring. Live, the time that each took from
// its arrival is recorded. The driver's thread.
class TimedReturns final : public Sink<ReturnBatch> {
 public:
  explicit TimedReturns(SpscRing<ReturnBatch>& worker) noexcept : worker_(worker) {}
  // Before the thread starts. `stages` outlives the sink.
  void measure_into(StageHistograms& stages) noexcept { stages_ = &stages; }

  [[nodiscard]] ReturnBatch* claim() noexcept override { return claimed_ = worker_.claim(); }
  void commit() noexcept override {
    const HostTime arrival = claimed_->arrival;
    worker_.commit();
    if (stages_ != nullptr) stages_->record(Stage::arrival_to_ring, live::host_now() - arrival);
  }

 private:
  SpscRing<ReturnBatch>& worker_;
  StageHistograms* stages_ = nullptr;
  ReturnBatch* claimed_ = nullptr;
};

// What is between the inputs' threads and the rest of the daemon.
struct InputRings {
  // 0.57 s of an HDL-32E (1808 packets/s), with dual returns (3617 packets/s) too: several periods
  // of the worker. A slot has 9 kB of locked memory, so what only dual returns need is not taken
  // without them.
  static constexpr std::size_t kLidarSlots = 1024;
  static constexpr std::size_t kDualReturnLidarSlots = 2048;
  // 2.5 s at 400 Hz.
  static constexpr std::size_t kImuSlots = 1024;
  // 1 s of a stage that sends every millisecond.
  static constexpr std::size_t kEncoderSlots = 1024;

  explicit InputRings(bool dual_returns)
      : lidar(dual_returns ? kDualReturnLidarSlots : kLidarSlots) {}

  SpscRing<ReturnBatch> lidar;
  SpscRing<ImuSample> imu{kImuSlots};
  SpscRing<ImuSample> imu_publish{kImuSlots};
  SpscRing<EncoderSample> encoder{kEncoderSlots};
  WakeUp imu_publish_filled;
  // The producing ends, for the drivers.
  TimedReturns returns{lidar};
  ImuTee samples{imu, imu_publish, imu_publish_filled};
  RingSink<EncoderSample> angles{encoder};

  [[nodiscard]] std::uint64_t overruns() const noexcept {
    return lidar.overruns() + imu.overruns() + imu_publish.overruns() + encoder.overruns();
  }
};

}  // namespace convexcut::daemon
