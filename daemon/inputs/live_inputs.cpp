// SPDX-License-Identifier: Apache-2.0
#include "daemon/inputs/live_inputs.hpp"

#include <algorithm>
#include <chrono>

#include "daemon/inputs/lidar_totals.hpp"
#include "daemon/log/log.hpp"
#include "daemon/sources/live_health.hpp"

namespace convexcut::daemon {
namespace {

// A receive thread looks at the stop flag this often.
constexpr Duration kLongestWait = std::chrono::milliseconds{50};

std::unique_ptr<recorder::Recorder> make_recorder(const config::Record& record) {
  if (record.directory.empty()) return nullptr;
  return std::make_unique<recorder::Recorder>(recorder_options(record),
                                              [](bool problem, const std::string& line) {
                                                if (problem) {
                                                  log::error("recording", {{"problem", line}});
                                                } else {
                                                  log::info("recording", {{"note", line}});
                                                }
                                              });
}

}  // namespace

LiveInputs::LiveInputs(const config::Config& config, InputRings& rings,
                       const std::atomic<bool>& stop)
    : config_(config),
      stop_(stop),
      clock_(stop),
      recorder_(make_recorder(config.record)),
      sources_(config, rings.returns, rings.samples, rings.angles,
               recorder_ ? taps_of(*recorder_) : LiveTaps{}) {}

std::vector<InputThread> LiveInputs::start() {
  std::vector<InputThread> threads;
  bool has_imu = false;
  for (const LiveSources::Entry& entry : sources_.entries()) {
    has_imu = has_imu || entry.role == SourceRole::imu;
    threads.push_back({entry.name.data(), ThreadRole::receive, [this, &source = entry.source] {
                         // Relaxed: the flag only ends the loop, it publishes nothing.
                         while (!stop_.load(std::memory_order_relaxed)) {
                           source.receive(kLongestWait);
                         }
                         // What the kernel had received by then counts as received.
                         source.receive(Duration{0});
                       }});
  }
  if (!has_imu) imu_ended_.store(true, std::memory_order_release);  // see Inputs
  return threads;
}

InputTotals LiveInputs::totals() const noexcept {
  InputTotals totals = lidar_totals(sources_.lidar_driver());
  totals.kernel_drops = sources_.kernel_drops();
  if (const auto* imu = sources_.imu_driver()) {
    totals.imu_samples = imu->counters().samples.value();
    totals.lost_imu_samples = imu->counters().lost_messages.value();
  } else if (const auto* bus = sources_.bus()) {
    totals.imu_samples = bus->imu().counters().samples.value();
    totals.lost_imu_samples = bus->imu().counters().lost_groups.value();
  }
  return totals;
}

void LiveInputs::add_sources(HealthMonitor& health, const SequencerCounters& lidar_packets) const {
  for (const LiveSources::Entry& entry : sources_.entries()) {
    const bool is_lidar = entry.role == SourceRole::lidar;
    health.add_source(std::string(entry.name), is_required(sources_, entry, config_),
                      [this, &entry, &lidar_packets, is_lidar] {
                        SourceReading reading = reading_of(sources_, entry);
                        // What the kernel dropped is missing in the sequence too.
                        if (is_lidar) reading.lost = lidar_packets.lost.value();
                        return reading;
                      });
  }
}

RecordedTotals LiveInputs::recorded() const noexcept {
  if (!recorder_) return {};
  return {recorder_->counters().records.value(), recorder_->counters().bytes.value(),
          recorder_->missing()};
}

void LiveInputs::log_start() const {
  for (const LiveSources::Entry& entry : sources_.entries()) {
    log::info("input", {{"source", entry.name}, {"device", entry.device}});
  }
}

void LiveInputs::log_changes() {
  std::vector<std::string> now = sources_.warnings();
  const auto in = [](const std::vector<std::string>& lines, const std::string& line) {
    return std::find(lines.begin(), lines.end(), line) != lines.end();
  };
  for (const std::string& line : now) {
    if (!in(warnings_, line)) log::warning("source", {{"problem", line}});
  }
  for (const std::string& line : warnings_) {
    if (!in(now, line)) log::info("source", {{"resolved", line}});
  }
  warnings_ = std::move(now);
}

}  // namespace convexcut::daemon
