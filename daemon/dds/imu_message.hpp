// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/imu_sample.hpp"
#include "core/time.hpp"
#include "daemon/dds/ros2.h"

namespace convexcut::daemon {

// A sensor_msgs/Imu that refers to frame_id, which must outlive it. Cyclone DDS's C type wants a
// char*, hence no const; it is only read.
[[nodiscard]] sensor_msgs_msg_dds__Imu_ imu_message(const ImuSample& sample, HostTime stamp,
                                                    std::string& frame_id);

}  // namespace convexcut::daemon
