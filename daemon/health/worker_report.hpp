// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/health/clock_gauge.hpp"
#include "daemon/health/stages.hpp"

namespace convexcut::daemon {

// What the worker says of itself beside its counters. Written by the worker, read by any thread.
struct WorkerReport {
  StageHistograms& stages;
  ClockGauge lidar_clock;
  ClockGauge imu_clock;
};

}  // namespace convexcut::daemon
