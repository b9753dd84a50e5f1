// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/orientation.hpp"

#include <cmath>
#include <numbers>

namespace convexcut::xsens {
namespace {

std::optional<Quaternion> from_quaternion(const Reals<4>& wxyz) noexcept {
  const Quaternion q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const double length = q.norm();
  const bool plausible = length >= 0.5 && length <= 2.0;  // false for NaN, too
  if (!plausible) return std::nullopt;
  return q.normalized();
}

std::optional<Quaternion> from_matrix(const Reals<9>& column_by_column) noexcept {
  const Eigen::Matrix3d rotation(Eigen::Map<const Eigen::Matrix3d>(column_by_column.data()));
  static_assert(Eigen::Matrix3d::IsRowMajor == 0, "the wire's order is Eigen's");
  const Eigen::Matrix3d excess = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  const bool orthonormal = excess.norm() <= 0.01;  // false for NaN, too
  if (!orthonormal || rotation.determinant() < 0) return std::nullopt;
  return Quaternion(rotation).normalized();
}

std::optional<Quaternion> from_euler(const Reals<3>& roll_pitch_yaw_deg) noexcept {
  for (const double angle : roll_pitch_yaw_deg) {
    if (!std::isfinite(angle)) return std::nullopt;
  }
  return to_quaternion({Degrees{roll_pitch_yaw_deg[0]}, Degrees{roll_pitch_yaw_deg[1]},
                        Degrees{roll_pitch_yaw_deg[2]}})
      .normalized();
}

Quaternion level_from(CoordinateSystem frame) noexcept {
  // x ↔ y and z → −z: half a turn about the diagonal between x and y.
  constexpr double kDiagonal = std::numbers::sqrt2 / 2;
  if (frame == CoordinateSystem::ned) return {0, kDiagonal, kDiagonal, 0};
  return Quaternion::Identity();
}

template <class Convert, std::size_t N>
std::optional<Quaternion> levelled(Convert convert, const InFrame<N>& item) noexcept {
  std::optional<Quaternion> q = convert(item.value);
  if (q) *q = level_from(item.frame) * *q;
  return q;
}

}  // namespace

std::optional<Quaternion> q_level_from_imu(const MtMeasurement& m) noexcept {
  if (m.has(MtItem::quaternion)) return levelled(from_quaternion, m.quaternion);
  if (m.has(MtItem::rotation_matrix)) return levelled(from_matrix, m.rotation_matrix);
  if (m.has(MtItem::euler_angles)) return levelled(from_euler, m.euler_deg);
  return std::nullopt;
}

}  // namespace convexcut::xsens
