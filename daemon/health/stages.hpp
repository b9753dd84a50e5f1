// SPDX-License-Identifier: Apache-2.0
//
// How long the data takes through each stage of the daemon.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/histogram.hpp"
#include "core/ring/slot_array.hpp"

namespace convexcut::daemon {

enum class Stage : std::uint8_t {
  arrival_to_ring,    // a datagram's kernel stamp → its batch is in the ring; the receive thread
  arrival_to_worker,  // a datagram's kernel stamp → its batch is taken out; the worker
  level,              // a scan is levelled; the worker
  cut,                // … and cut into structure and the rest; the worker
  learn,              // what its labels did not wait for (robust); the worker
  publish,            // the DDS write of the structure; the publisher
  latency,            // a scan's last firing → that write returned; the publisher
  jitter,             // how far from its due time a write returned; the publisher
};

struct StageInfo {
  Stage stage;
  std::string_view name;
  std::string_view help;
};
inline constexpr std::array<StageInfo, 8> kStages{{
    {Stage::arrival_to_ring, "arrival_to_ring", "From a packet's arrival to its place in the ring"},
    {Stage::arrival_to_worker, "arrival_to_worker",
     "From a packet's arrival to the worker, which looks ten times a second"},
    {Stage::level, "level", "Levelling of a scan"},
    {Stage::cut, "cut", "Convex Cut of a scan"},
    {Stage::learn, "learn", "What is learnt from a scan after its labels are handed over"},
    {Stage::publish, "publish", "DDS write of the structure"},
    {Stage::latency, "latency", "From a scan's last firing to the end of its DDS write"},
    {Stage::jitter, "jitter", "How far the latency was from worker.latency_ms"},
}};
static_assert([] {
  for (std::size_t i = 0; i < kStages.size(); ++i) {
    if (static_cast<std::size_t>(kStages[i].stage) != i) return false;
  }
  return true;
}());

// Each histogram is written by the thread named above, and readable from any.
class StageHistograms {
 public:
  void record(Stage stage, Duration duration) noexcept {
    histograms_[static_cast<std::size_t>(stage)].value.record(duration);
  }
  [[nodiscard]] const LatencyHistogram& of(Stage stage) const noexcept {
    return histograms_[static_cast<std::size_t>(stage)].value;
  }

 private:
  // What different threads write is on different cache lines.
  struct alignas(kCacheLine) Padded {
    LatencyHistogram value;
  };
  std::array<Padded, kStages.size()> histograms_;
};

}  // namespace convexcut::daemon
