// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/clock/clock_mapping.hpp"
#include "core/clock/hour_clock.hpp"
#include "core/return_batch.hpp"
#include "core/scan/packet_sequencer.hpp"
#include "core/scan/scan_cutter.hpp"
#include "core/sink.hpp"

namespace convexcut::replay {

// Follows a lidar's batches through clock, sequencer and cutter, with every return kept, and
// remembers what a person wants to know of a recording. Memory grows by a few bytes a revolution.
class LidarInspector final : public Sink<ReturnBatch> {
 public:
  struct Revolution {
    std::uint32_t firings = 0;
    std::uint32_t returns = 0;
    double coverage = 0.0;
    ScanEnd end = ScanEnd::cut;
  };

  explicit LidarInspector(Azimuth cut_azimuth);

  [[nodiscard]] ReturnBatch* claim() noexcept override { return &batch_; }
  void commit() noexcept override;
  void finish();

  [[nodiscard]] HostTime first() const noexcept { return first_; }
  [[nodiscard]] HostTime last() const noexcept { return last_; }
  [[nodiscard]] Duration sensor_span() const noexcept { return last_firing_ - first_firing_; }
  [[nodiscard]] std::uint32_t firing_period_ns() const noexcept { return batch_.firing_period_ns; }
  [[nodiscard]] bool dual_return() const noexcept { return dual_return_; }
  [[nodiscard]] PpsState pps() const noexcept { return batch_.pps; }
  [[nodiscard]] double rotor_hz() const noexcept { return rotor_hz_; }
  [[nodiscard]] ClockState clock() const noexcept { return clock_.state(); }
  [[nodiscard]] const SequencerCounters& order() const noexcept { return sequencer_.counters(); }
  [[nodiscard]] const std::vector<Revolution>& revolutions() const noexcept { return revolutions_; }

 private:
  void on_scan(const Scan& scan);

  ReturnBatch batch_{};
  HourClock hour_clock_;
  ClockMapping<LidarTime> clock_;
  PacketSequencer sequencer_;
  ScanCutter cutter_;
  std::vector<Revolution> revolutions_;
  HostTime first_ = HostTime::max();
  HostTime last_ = HostTime::min();
  LidarTime first_firing_ = LidarTime::max();
  LidarTime last_firing_ = LidarTime::min();
  bool dual_return_ = false;
  double rotor_hz_ = 0.0;
};

}  // namespace convexcut::replay
