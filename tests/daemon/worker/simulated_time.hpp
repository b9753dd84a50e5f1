// SPDX-License-Identifier: Apache-2.0
//
// The worker in simulated time: whenever it waits, time passes at once, and what would have been
// received meanwhile is put into its rings. One thread, so every run is the same.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "daemon/clock/clock.hpp"
#include "daemon/worker.hpp"
#include "tests/core/scan/synthetic_lidar.hpp"

namespace convexcut::daemon {

// A host's clock that stands still except in waits, and that can be set.
class SimulatedClock final : public Clock {
 public:
  static constexpr HostTime kStart = from_ns<HostTime>(1'700'000'000'000'000'000);

  explicit SimulatedClock(const std::atomic<bool>& stop) : Clock(stop) {}

  // The clock that stamps what is received; now() is behind it until take_step().
  [[nodiscard]] HostTime kernel_now() const { return HostTime{steady_ + kernel_offset_}; }
  void set_by(Duration step) { kernel_offset_ += step; }

  [[nodiscard]] HostTime now() const noexcept override { return HostTime{steady_ + offset_}; }
  [[nodiscard]] Steady::time_point steady_at(HostTime time) const noexcept override {
    return Steady::time_point{time.time_since_epoch() - offset_};
  }
  [[nodiscard]] HostTime host_at(Steady::time_point time) const noexcept override {
    return HostTime{time.time_since_epoch() + offset_};
  }
  [[nodiscard]] Duration take_step() noexcept override {
    const Duration step = kernel_offset_ - offset_;
    offset_ = kernel_offset_;
    return step;
  }
  [[nodiscard]] Steady::time_point steady_now() const { return Steady::time_point{steady_}; }

  // Called for every instant that time passes.
  std::function<void()> on_time;

 protected:
  void sleep_until(Steady::time_point time) const noexcept override {
    constexpr Duration kGrain = std::chrono::microseconds{100};
    while (steady_ < time.time_since_epoch()) {
      steady_ = std::min<Duration>(steady_ + kGrain, time.time_since_epoch());
      on_time();
    }
  }

 private:
  mutable Duration steady_ = std::chrono::seconds{1'000};
  Duration offset_ = kStart.time_since_epoch() - steady_;
  Duration kernel_offset_ = offset_;
};

// What was handed to the publisher, and when.
struct Taken {
  std::uint64_t index = 0;
  ScanEnd end = ScanEnd::cut;
  HostTime stamp{};
  HostTime last_firing{};
  std::size_t points = 0;
  Clock::Steady::time_point due{};
  Clock::Steady::time_point at{};
};

class SimulatedWorker {
 public:
  SimulatedWorker() {
    reserve_slots(results, Pipeline::kMaxReturnsPerScan);
    lidar.start = LidarTime{};
    lidar.returns_per_firing = 1;
    lidar.start_degrees = 123.0;
    clock.on_time = [this] { pass(); };
  }

  // Whether the sensor sends at a time since the start.
  std::function<bool(Duration)> powered = [](Duration) { return true; };
  // When the input is over, as a recording's is; never without it.
  std::optional<Duration> input_ends;
  // How much later than normal a packet comes that was sent at a time since the start.
  std::function<Duration(Duration)> delay = [](Duration) { return Duration{0}; };
  // Called as time passes.
  std::function<void(Duration)> at = [](Duration) {};

  void run(Duration span) {
    PipelineOptions options;
    options.fixed_mount = true;
    options.convex_cut.planes = 4;
    run(span, options);
  }
  void run(Duration span, const PipelineOptions& options) {
    span_ = span;
    begin_ = clock.steady_now();
    Worker simulated(options, {.reduce_effort = false}, clock, returns, samples, angles, results);
    worker = &simulated;
    simulated.run(stop, lidar_ended, imu_ended);
    if (lidar_ended) take();  // what it handed over without waiting once more
    counters = {simulated.counters().empty_results.value(),
                simulated.counters().superseded_scans.value(),
                simulated.counters().dropped_scans.value(),
                simulated.counters().missed_instants.value(),
                simulated.counters().clock_steps.value(),
                simulated.counters().dropped_by_clock_step.value()};
    worker = nullptr;
  }

  struct Counts {
    std::uint64_t empty_results = 0;
    std::uint64_t superseded_scans = 0;
    std::uint64_t dropped_scans = 0;
    std::uint64_t missed_instants = 0;
    std::uint64_t clock_steps = 0;
    std::uint64_t dropped_by_clock_step = 0;
  };

  std::atomic<bool> stop{false};
  SimulatedClock clock{stop};
  test::SyntheticLidar lidar;
  std::vector<Taken> taken;
  Counts counters;
  Worker* worker = nullptr;

 private:
  void pass() {
    const Duration elapsed = clock.steady_now() - begin_;
    at(elapsed);
    if (elapsed >= span_) stop = true;
    while (!lidar_ended && arrival(next_packet_) <= elapsed) receive(next_packet_++);
    if (input_ends && elapsed >= *input_ends) lidar_ended = true;
    take();
  }

  void take() {
    results.consume([this](Result& result) noexcept {
      const LevelledScan& scan = result.scan;
      taken.push_back({scan.index, scan.end, scan.stamp, scan.last_firing, scan.size(), result.due,
                       clock.steady_now()});
    });
  }

  // When a packet arrives, since the start: when its last firing is over.
  [[nodiscard]] Duration arrival(std::int64_t packet) const {
    const Duration sent = lidar.time(packet + 1) - LidarTime{};
    return sent + delay(sent);
  }

  void receive(std::int64_t packet) {
    if (!powered(lidar.time(packet) - LidarTime{})) return;
    constexpr std::int64_t kCountAtStart = 1'000'000'000;
    ReturnBatch* slot = returns.claim();
    if (slot == nullptr) return;
    *slot = lidar.packet(packet).batch;
    const std::int64_t count = kCountAtStart + (lidar.time(packet) - LidarTime{}).count() / 1000;
    slot->first_firing = {static_cast<std::uint32_t>(count % 3'600'000'000)};
    slot->arrival = clock.kernel_now();
    returns.commit();
  }

  std::atomic<bool> lidar_ended{false};
  std::atomic<bool> imu_ended{true};
  SpscRing<ReturnBatch> returns{2048};
  SpscRing<ImuSample> samples{16};
  SpscRing<EncoderSample> angles{16};
  ResultRing results{4};
  Clock::Steady::time_point begin_{};
  Duration span_{};
  std::int64_t next_packet_ = 0;
};

}  // namespace convexcut::daemon
