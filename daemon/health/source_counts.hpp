// SPDX-License-Identifier: Apache-2.0
//
// From a driver's counters to the three numbers that health looks at.
#pragma once

#include <cstdint>

#include "daemon/health/source_health.hpp"
#include "drivers/can/can_imu_driver.hpp"
#include "drivers/velodyne/lidar_driver.hpp"
#include "drivers/xsens/imu_driver.hpp"

namespace convexcut::daemon {

// The link is left for the caller to fill in, and of the lidar also `lost`, which only the packet
// sequencer knows.
[[nodiscard]] SourceReading reading_of(const velodyne::LidarCounters& counters) noexcept;
[[nodiscard]] SourceReading reading_of(const xsens::ImuCounters& counters) noexcept;
[[nodiscard]] SourceReading reading_of(const can::CanImuCounters& counters) noexcept;

// The same with the link's own word.
template <class Counters>
[[nodiscard]] SourceReading reading_of(const live::LiveSource& source,
                                       const Counters& counters) noexcept {
  SourceReading reading = reading_of(counters);
  reading.link = source.link();
  reading.last_error = source.last_error();
  return reading;
}

}  // namespace convexcut::daemon
