// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "config/config.hpp"
#include "daemon/clock/playback_clock.hpp"
#include "daemon/inputs/input_rings.hpp"
#include "daemon/inputs/inputs.hpp"
#include "daemon/sources/recordings.hpp"

namespace convexcut::daemon {

// Recordings, played at a rate: one thread a stream while paced; at rate `max` one thread for all,
// which waits for room in the rings, so that nothing is lost.
class RecordedInputs final : public Inputs {
 public:
  // rate: see PlaybackClock. Throws what Recordings throws.
  RecordedInputs(const RecordingPaths& paths, const config::Config& config, double rate,
                 InputRings& rings, const std::atomic<bool>& stop);

  [[nodiscard]] std::vector<InputThread> start() override;
  [[nodiscard]] Clock& clock() noexcept override { return clock_; }
  [[nodiscard]] InputTotals totals() const noexcept override;
  [[nodiscard]] double pace() const noexcept override {
    return clock_.paced() && rate_ < 1.0 ? rate_ : 1.0;
  }
  void add_sources(HealthMonitor& health, const SequencerCounters& lidar_packets) const override;
  void log_start() const override;
  void log_end() const override;
  void check_content() const override { recordings_.check_content(); }

 private:
  void play(recording::RecordedStream& stream, std::atomic<bool>* ended);
  void play_merged();
  // Relaxed: the flag only ends the loops, it publishes nothing.
  [[nodiscard]] bool stopped() const noexcept { return stop_.load(std::memory_order_relaxed); }

  RecordingPaths paths_;
  double rate_;
  InputRings& rings_;
  const std::atomic<bool>& stop_;
  PlaybackClock clock_;
  Recordings recordings_;
};

}  // namespace convexcut::daemon
