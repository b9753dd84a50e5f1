// SPDX-License-Identifier: Apache-2.0
//
// From the configuration's words to the drivers' options.
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
  options.time_offset = std::chrono::microseconds{lidar.time_offset_us};
  return options;
}

}  // namespace convexcut::daemon
