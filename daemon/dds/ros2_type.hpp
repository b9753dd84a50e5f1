// SPDX-License-Identifier: Apache-2.0
//
// The message types on our topics, with what ROS 2 wants to know of them.
#pragma once

#include <string_view>

#include <dds/dds.h>

#include "daemon/dds/ros2.h"

namespace convexcut::daemon {

struct Ros2Type {
  const dds_topic_descriptor_t* descriptor;
  // ROS 2's type hash (REP-2011). Endpoints tell theirs; one that does not costs every ROS 2
  // process (Iron and later) a warning. It is not used for matching.
  std::string_view type_hash;
};

inline const Ros2Type kPointCloud2Type{
    &sensor_msgs_msg_dds__PointCloud2__desc,
    "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"};
inline const Ros2Type kImuType{
    &sensor_msgs_msg_dds__Imu__desc,
    "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b"};
inline const Ros2Type kDiagnosticArrayType{
    &diagnostic_msgs_msg_dds__DiagnosticArray__desc,
    "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"};
inline const Ros2Type kHealthType{
    &convexcut_msg_dds__Health__desc,
    "RIHS01_0eb34029d70c489980955e1bf6e9b42a22233ca4cb4aa069d36af192dbdfac1d"};
inline const Ros2Type kScanStatusType{
    &convexcut_msg_dds__ScanStatus__desc,
    "RIHS01_9b616e74a4e3f41811b9c0a005d6a473b82ba7c2420566713fc4c3e0f627d05a"};

}  // namespace convexcut::daemon
