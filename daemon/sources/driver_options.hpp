// SPDX-License-Identifier: Apache-2.0
//
// From the configuration's words to the options of drivers and byte sources.
#pragma once

#include "config/config.hpp"
#include "drivers/can/bus_devices.hpp"
#include "drivers/serial/serial_source.hpp"
#include "drivers/socketcan/socketcan_source.hpp"
#include "drivers/udp/udp_source.hpp"
#include "drivers/velodyne/lidar_driver.hpp"
#include "drivers/xsens/imu_driver.hpp"

namespace convexcut::daemon {

[[nodiscard]] velodyne::LidarDriverOptions lidar_driver_options(const config::Lidar& lidar);
[[nodiscard]] xsens::ImuDriverOptions imu_driver_options(const config::Imu& imu);
[[nodiscard]] can::CanImuOptions can_driver_options(const config::Can& settings);
// The IMU, and the encoder when it is used.
[[nodiscard]] can::BusOptions bus_options(const config::Config& config);

[[nodiscard]] udp::UdpSourceOptions udp_source_options(const config::Lidar& lidar);
[[nodiscard]] socketcan::SocketCanOptions socketcan_options(const config::Config& config);
// Throws config::ConfigError for a rate that serial lines do not have.
[[nodiscard]] serial::SerialSourceOptions serial_source_options(const config::Imu& imu);

}  // namespace convexcut::daemon
