// SPDX-License-Identifier: Apache-2.0
//
// From the configuration's words to the drivers' options.
#include "config/text_rules.hpp"
#include "daemon/sources/recordings.hpp"

namespace convexcut::daemon {
namespace {

[[nodiscard]] std::optional<velodyne::ModelId> model_id(config::LidarModel model) {
  switch (model) {
    case config::LidarModel::automatic:
      return std::nullopt;
    case config::LidarModel::hdl32e:
      return velodyne::ModelId::hdl32e;
    case config::LidarModel::vlp16:
      return velodyne::ModelId::vlp16;
    case config::LidarModel::puck_hires:
      return velodyne::ModelId::puck_hires;
    case config::LidarModel::vlp32c:
      return velodyne::ModelId::vlp32c;
  }
  return std::nullopt;
}

}  // namespace

velodyne::LidarDriverOptions lidar_driver_options(const config::Lidar& lidar) {
  velodyne::LidarDriverOptions options;
  options.model = model_id(lidar.model);
  options.data_port = lidar.data_port;
  options.position_port = lidar.position_port;
  options.vertical_offsets = lidar.vertical_offsets;
  if (const auto address = config::parse_ipv4(lidar.source_address)) {
    options.from = Ipv4Address{*address};
  }
  options.time_offset = std::chrono::microseconds{lidar.time_offset_us};
  return options;
}

xsens::ImuDriverOptions imu_driver_options(const config::Imu& imu) {
  xsens::ImuDriverOptions options;
  options.baud = imu.baud;
  return options;
}

can::CanImuOptions can_driver_options(const config::Can& settings) {
  using Message = can::XsensMessage;
  can::CanImuOptions options;
  options.bitrate = settings.bitrate;
  options.ids[Message::sample_time] = settings.sample_time_id;
  options.ids[Message::group_counter] = settings.group_counter_id;
  options.ids[Message::status_word] = settings.status_id;
  options.ids[Message::quaternion] = settings.quaternion_id;
  options.ids[Message::euler_angles] = settings.euler_id;
  options.ids[Message::rate_of_turn] = settings.rate_of_turn_id;
  options.ids[Message::acceleration] = settings.acceleration_id;
  options.ids.extended = settings.extended_ids;
  return options;
}

}  // namespace convexcut::daemon
