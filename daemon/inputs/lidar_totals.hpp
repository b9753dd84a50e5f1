// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/inputs/inputs.hpp"
#include "drivers/velodyne/lidar_driver.hpp"

namespace convexcut::daemon {

// The lidar's part of an input's totals.
[[nodiscard]] inline InputTotals lidar_totals(const velodyne::LidarDriver& driver) noexcept {
  const velodyne::LidarCounters& counters = driver.counters();
  InputTotals totals;
  if (const auto model = driver.model()) totals.model = velodyne::model_of(*model).name;
  totals.lidar_packets = counters.data_packets.value();
  totals.rejected_lidar_packets =
      counters.foreign.value() + counters.wrong_length.value() + counters.wrong_block_flag.value() +
      counters.azimuth_out_of_range.value() + counters.timestamp_out_of_range.value() +
      counters.no_sentence.value() + counters.model_unknown.value();
  return totals;
}

}  // namespace convexcut::daemon
