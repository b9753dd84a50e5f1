// SPDX-License-Identifier: Apache-2.0
#include "replay/info.hpp"

#include <cstdio>
#include <vector>

#include "replay/info/can_info.hpp"
#include "replay/info/imu_info.hpp"
#include "replay/info/lidar_info.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {
namespace {

template <class Info>
void show(const Info& info, bool json, std::vector<JsonObject>& objects) {
  if (json) {
    objects.push_back(info.json());
  } else {
    info.print();
  }
}

}  // namespace

void info(const InfoOptions& options) {
  const daemon::RecordingPaths& paths = options.recordings;
  std::vector<JsonObject> objects;
  if (!paths.lidar.empty()) {
    show(LidarInfo(paths.lidar, options.config.lidar), options.json, objects);
  }
  if (!paths.imu.empty()) show(ImuInfo(paths.imu, options.config.imu), options.json, objects);
  if (!paths.can.empty()) show(CanInfo(paths.can, options.config), options.json, objects);
  if (options.json) {
    std::puts(JsonObject().add("recordings", objects).text().c_str());
  }
}

}  // namespace convexcut::replay
