// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "daemon/clock/live_clock.hpp"
#include "daemon/inputs/input_rings.hpp"
#include "daemon/inputs/inputs.hpp"
#include "daemon/sources/live_sources.hpp"
#include "daemon/sources/recording_setup.hpp"

namespace convexcut::daemon {

// The sensors themselves, one receive thread each, on the host's own clock; recorded when the
// configuration asks for it.
class LiveInputs final : public Inputs {
 public:
  // Throws what LiveSources and Recorder throw.
  LiveInputs(const config::Config& config, InputRings& rings, const std::atomic<bool>& stop);

  [[nodiscard]] std::vector<InputThread> start() override;
  [[nodiscard]] Clock& clock() noexcept override { return clock_; }
  [[nodiscard]] InputTotals totals() const noexcept override;
  void add_sources(HealthMonitor& health, const SequencerCounters& lidar_packets) const override;
  [[nodiscard]] RecordedTotals recorded() const noexcept override;
  void log_start() const override;
  void log_changes() override;
  void log_end() const override {}
  void check_content() const override {}  // a sensor that is off is no failure

 private:
  const config::Config config_;
  const std::atomic<bool>& stop_;
  LiveClock clock_;
  std::unique_ptr<recorder::Recorder> recorder_;  // above what it is a tap of; null: none
  LiveSources sources_;
  std::vector<std::string> warnings_;  // that have been logged and still hold
};

}  // namespace convexcut::daemon
