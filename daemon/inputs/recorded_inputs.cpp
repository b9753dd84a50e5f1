// SPDX-License-Identifier: Apache-2.0
#include "daemon/inputs/recorded_inputs.hpp"

#include <chrono>
#include <string>
#include <thread>

#include "daemon/health/source_counts.hpp"
#include "daemon/inputs/lidar_totals.hpp"
#include "daemon/log/log.hpp"

namespace convexcut::daemon {

RecordedInputs::RecordedInputs(const RecordingPaths& paths, const config::Config& config,
                               double rate, InputRings& rings, const std::atomic<bool>& stop)
    : paths_(paths),
      rate_(rate),
      rings_(rings),
      stop_(stop),
      clock_(rate, stop),
      recordings_(paths, config, rings.returns, rings.samples, rings.angles) {}

std::vector<InputThread> RecordedInputs::start() {
  clock_.start(recordings_.first_stamp());
  if (!clock_.paced()) return {{"play", ThreadRole::other, [this] { play_merged(); }}};
  const auto streams = recordings_.streams();
  std::vector<InputThread> threads;
  threads.push_back({"play_lidar", ThreadRole::other,
                     [this, lidar = streams.front()] { play(*lidar, &lidar_ended_); }});
  if (streams.size() == 1) imu_ended_.store(true, std::memory_order_release);
  // The first of the others is what orientation is taken from. A second is decoded only, unless it
  // has the angles of a stage: then it decides when orientations end.
  const bool has_angles = recordings_.can() != nullptr && recordings_.can()->encoder() != nullptr;
  const std::size_t decisive = has_angles ? streams.size() - 1 : 1;
  for (std::size_t i = 1; i < streams.size(); ++i) {
    std::atomic<bool>* ended = i == decisive ? &imu_ended_ : nullptr;
    threads.push_back({"play_imu", ThreadRole::other,
                       [this, stream = streams[i], ended] { play(*stream, ended); }});
  }
  return threads;
}

void RecordedInputs::play(recording::RecordedStream& stream, std::atomic<bool>* ended) {
  while (const auto stamp = stream.next_stamp()) {
    clock_.wait_until(*stamp);
    if (stopped()) break;
    stream.deliver();
  }
  stream.finish();
  if (ended != nullptr) ended->store(true, std::memory_order_release);  // see Inputs
}

void RecordedInputs::play_merged() {
  // As fast as possible means: as fast as the rings are emptied. Nothing is lost.
  const auto full = [](const auto& ring) { return ring.size_approx() + 8 > ring.capacity(); };
  while (!stopped()) {
    if (full(rings_.lidar) || full(rings_.imu) || full(rings_.imu_publish) ||
        full(rings_.encoder)) {
      std::this_thread::sleep_for(std::chrono::microseconds{100});
      continue;
    }
    const auto stamp = recordings_.step();
    if (!stamp) break;
    clock_.delivered(*stamp);
  }
  recordings_.finish();
  lidar_ended_.store(true, std::memory_order_release);  // see Inputs
  imu_ended_.store(true, std::memory_order_release);
}

InputTotals RecordedInputs::totals() const noexcept {
  InputTotals totals = lidar_totals(recordings_.lidar_driver());
  if (const auto* imu = recordings_.imu()) {
    totals.imu_samples = imu->counters().samples.value();
    totals.lost_imu_samples = imu->counters().lost_messages.value();
  } else if (const auto* can = recordings_.can()) {
    totals.imu_samples = can->counters().samples.value();
    totals.lost_imu_samples = can->counters().lost_groups.value();
  }
  return totals;
}

// A recording is there for as long as it lasts.
void RecordedInputs::add_sources(HealthMonitor& health,
                                 const SequencerCounters& lidar_packets) const {
  const auto there = [](SourceReading reading) {
    reading.link = live::LinkState::open;
    return reading;
  };
  health.add_source("lidar", true, [this, &lidar_packets, there] {
    SourceReading reading = there(reading_of(recordings_.lidar_driver().counters()));
    reading.lost = lidar_packets.lost.value();
    return reading;
  });
  if (const auto* imu = recordings_.imu()) {
    health.add_source("imu", false, [imu, there] { return there(reading_of(imu->counters())); });
  }
  if (const auto* can = recordings_.can()) {
    health.add_source("can", false, [can, there] { return there(reading_of(can->counters())); });
  }
}

void RecordedInputs::log_start() const {
  log::info("input", {{"lidar", paths_.lidar.string()},
                      {"imu", paths_.imu.string()},
                      {"can", paths_.can.string()},
                      {"rate", clock_.paced() ? std::to_string(rate_) : "max"}});
}

void RecordedInputs::log_end() const {
  for (const std::string& warning : recordings_.warnings()) {
    log::warning("recording", {{"problem", warning}});
  }
}

}  // namespace convexcut::daemon
