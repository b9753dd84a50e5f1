// SPDX-License-Identifier: Apache-2.0
#include "core/scan/stage.hpp"

#include <cmath>

namespace convexcut {

Quaternion stage_rotation(StageAxis axis, Radians angle) noexcept {
  const Vec3 about = axis == StageAxis::tilt ? Vec3::UnitY() : Vec3::UnitZ();
  return Quaternion(Eigen::AngleAxisd(angle.value, about));
}

Radians heading(const Quaternion& q_level_from_body) noexcept {
  constexpr double kVertical = 1e-6;
  const Vec3 x = q_level_from_body * Vec3::UnitX();
  if (std::hypot(x.x(), x.y()) > kVertical) return {std::atan2(x.y(), x.x())};
  const Vec3 y = q_level_from_body * Vec3::UnitY();
  return {std::atan2(-y.x(), y.y())};
}

Quaternion with_heading(const Quaternion& q_level_from_lidar,
                        const Quaternion& q_base_from_lidar) noexcept {
  const Eigen::AngleAxisd back(-heading(q_level_from_lidar).value, Vec3::UnitZ());
  return q_base_from_lidar * Quaternion(back) * q_level_from_lidar;
}

}  // namespace convexcut
