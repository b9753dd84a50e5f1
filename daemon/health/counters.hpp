// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace convexcut::daemon {

// What the daemon counts beside its sources; totals since the start.
struct HealthCounters {
  std::uint64_t results = 0;
  std::uint64_t empty_results = 0;
  std::uint64_t late_results = 0;
  std::uint64_t dropped_scans = 0;
  std::uint64_t reduced_scans = 0;
  std::uint64_t unturned_scans = 0;
  std::uint64_t points_without_orientation = 0;
  std::uint64_t late_packets = 0;
  std::uint64_t ring_overruns = 0;
  std::uint64_t publish_timeouts = 0;
  std::uint64_t recorded_records = 0;
  std::uint64_t recorded_bytes = 0;
  std::uint64_t unrecorded_records = 0;
};

// One counter as all formats show it: Prometheus appends "_total".
struct CounterInfo {
  std::uint64_t HealthCounters::*value;
  std::string_view name;
  std::string_view help;
  // What is wrong while it increases; empty: nothing.
  std::string_view loss;
};

inline constexpr std::array<CounterInfo, 13> kHealthCounters{{
    {&HealthCounters::results, "results", "Scans published, empty ones included", ""},
    {&HealthCounters::empty_results, "empty_results", "Results published without lidar data", ""},
    {&HealthCounters::late_results, "late_results", "Scans published after worker.latency_ms",
     "results late"},
    {&HealthCounters::dropped_scans, "dropped_scans", "Scans dropped because publishing was behind",
     "scans dropped"},
    {&HealthCounters::reduced_scans, "reduced_scans",
     "Scans computed with less than the configured effort because time was short", "scans reduced"},
    {&HealthCounters::unturned_scans, "unturned_scans",
     "Scans without a whole revolution: the rotor stands or turns too slowly", "lidar not turning"},
    {&HealthCounters::points_without_orientation, "points_without_orientation",
     "Points dropped because no orientation was known at their time", "orientations missing"},
    {&HealthCounters::late_packets, "late_packets",
     "Lidar packets that came after their scan had been cut", "packets late"},
    {&HealthCounters::ring_overruns, "ring_overruns",
     "Packets and samples dropped because the worker was behind", "ring overruns"},
    {&HealthCounters::publish_timeouts, "publish_timeouts",
     "DDS writes given up after dds.max_blocking_ms", "publishing timed out"},
    {&HealthCounters::recorded_records, "recorded_records",
     "Packets, reads and frames written to the recording", ""},
    {&HealthCounters::recorded_bytes, "recorded_bytes", "Bytes written to the recording", ""},
    {&HealthCounters::unrecorded_records, "unrecorded_records",
     "Packets, reads and frames missing from the recording", "recording incomplete"},
}};
static_assert(sizeof(HealthCounters) == kHealthCounters.size() * sizeof(std::uint64_t),
              "every counter is in the table");

}  // namespace convexcut::daemon
