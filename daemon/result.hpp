// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/ring/spsc_ring.hpp"
#include "core/scan/scan.hpp"
#include "daemon/clock/clock.hpp"
#include "daemon/pipeline/effort.hpp"

namespace convexcut::daemon {

// What the worker hands to the publisher at one instant of its grid.
struct Result {
  LevelledScan scan;  // ScanEnd::no_data: an empty result
  // When the write of it shall return. On CLOCK_MONOTONIC, so that a step of the host's clock does
  // not reach what is already decided. Not used when time is not paced.
  Clock::Steady::time_point due{};
  Effort effort = Effort::full;  // that its labels were computed with
};

using ResultRing = SpscRing<Result>;

// Gives every slot of the ring its memory, so that the worker never allocates. Before the threads
// start.
void reserve_slots(ResultRing& results, std::size_t max_points);

}  // namespace convexcut::daemon
