// SPDX-License-Identifier: Apache-2.0
//
// Conversions to imu → level. Does not prove which frame a real device was configured for.
#include "drivers/xsens/orientation.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace convexcut::xsens {
namespace {

MtMeasurement with_quaternion(Reals<4> wxyz, CoordinateSystem frame = CoordinateSystem::enu) {
  MtMeasurement m;
  m.quaternion = {wxyz, frame};
  m.add(MtItem::quaternion);
  return m;
}

MtMeasurement with_matrix(Reals<9> columns, CoordinateSystem frame = CoordinateSystem::enu) {
  MtMeasurement m;
  m.rotation_matrix = {columns, frame};
  m.add(MtItem::rotation_matrix);
  return m;
}

MtMeasurement with_euler(Reals<3> rpy_deg, CoordinateSystem frame = CoordinateSystem::enu) {
  MtMeasurement m;
  m.euler_deg = {rpy_deg, frame};
  m.add(MtItem::euler_angles);
  return m;
}

void expect_same_rotation(const Quaternion& a, const Quaternion& b, double tolerance) {
  EXPECT_LT((a.toRotationMatrix() - b.toRotationMatrix()).cwiseAbs().maxCoeff(), tolerance);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(Orientation, QuaternionIsNormalised) {
  const auto q = q_level_from_imu(with_quaternion({0.8, 0, 0, 0.7}));
  ASSERT_TRUE(q);
  EXPECT_NEAR(q->norm(), 1.0, 1e-15);
  EXPECT_NEAR(q->z() / q->w(), 0.7 / 0.8, 1e-15);
}

// A recorded MTi-G-710 message held both.
TEST(Orientation, MatrixColumnByColumnEqualsTheQuaternionOfTheSameMessage) {
  const auto matrix = q_level_from_imu(with_matrix(
      {-0.99995, 0.00991, 0.0017, -1.6e-5, 0.16768, -0.98584, -0.01006, -0.98579, -0.16767}));
  const auto quaternion =
      q_level_from_imu(with_quaternion({0.003847, -0.003238, -0.764084, 0.645097}));
  ASSERT_TRUE(matrix && quaternion);
  expect_same_rotation(*matrix, *quaternion, 2e-5);
}

TEST(Orientation, EulerAnglesAreDegreesRollFirst) {
  const auto q = q_level_from_imu(with_euler({90, 0, 90}));
  ASSERT_TRUE(q);
  EXPECT_TRUE((*q * Vec3::UnitY()).isApprox(Vec3::UnitZ(), 1e-12));
  EXPECT_TRUE((*q * Vec3::UnitX()).isApprox(Vec3::UnitY(), 1e-12));
}

TEST(Orientation, AllThreeFormsOfOneRotationAgree) {
  const Quaternion truth = to_quaternion({Degrees{25}, Degrees{-40}, Degrees{130}});
  const Eigen::Matrix3d r = truth.toRotationMatrix();
  Reals<9> columns{};
  for (Eigen::Index i = 0; i < 9; ++i) columns[static_cast<std::size_t>(i)] = r(i % 3, i / 3);
  for (const CoordinateSystem frame :
       {CoordinateSystem::enu, CoordinateSystem::ned, CoordinateSystem::nwu}) {
    const auto a =
        q_level_from_imu(with_quaternion({truth.w(), truth.x(), truth.y(), truth.z()}, frame));
    const auto b = q_level_from_imu(with_matrix(columns, frame));
    const auto c = q_level_from_imu(with_euler({25, -40, 130}, frame));
    ASSERT_TRUE(a && b && c);
    expect_same_rotation(*a, *b, 1e-12);
    expect_same_rotation(*a, *c, 1e-12);
  }
}

TEST(Orientation, NedExchangesXAndYAndNegatesZ) {
  // Level in NED with the sensor's x to the north: the sensor's z points down.
  const auto q = q_level_from_imu(with_quaternion({1, 0, 0, 0}, CoordinateSystem::ned));
  ASSERT_TRUE(q);
  EXPECT_TRUE((*q * Vec3::UnitX()).isApprox(Vec3::UnitY(), 1e-15)) << "north";
  EXPECT_TRUE((*q * Vec3::UnitY()).isApprox(Vec3::UnitX(), 1e-15)) << "east";
  EXPECT_TRUE((*q * Vec3::UnitZ()).isApprox(-Vec3::UnitZ(), 1e-15)) << "down";
}

TEST(Orientation, NedAndEnuOfTheSamePoseAgree) {
  // The sensor lies flat, z up, x towards east: identity in ENU; in NED x → (0,1,0), y → (1,0,0).
  const double h = std::sqrt(0.5);
  const auto ned = q_level_from_imu(with_quaternion({0, h, h, 0}, CoordinateSystem::ned));
  const auto enu = q_level_from_imu(with_quaternion({1, 0, 0, 0}));
  ASSERT_TRUE(ned && enu);
  expect_same_rotation(*ned, *enu, 1e-12);
}

TEST(Orientation, NedIsTurnedInTheLocalFrameNotInTheSensors) {
  // Rolled to the right in NED with the nose to the north-east: sensor axes told one by one.
  const Quaternion q_ned = to_quaternion({Degrees{90}, Degrees{0}, Degrees{45}});
  const auto q = q_level_from_imu(
      with_quaternion({q_ned.w(), q_ned.x(), q_ned.y(), q_ned.z()}, CoordinateSystem::ned));
  ASSERT_TRUE(q);
  const double h = std::sqrt(0.5);
  EXPECT_TRUE((*q * Vec3::UnitX()).isApprox(Vec3(h, h, 0), 1e-12)) << "nose: north-east";
  EXPECT_TRUE((*q * Vec3::UnitY()).isApprox(-Vec3::UnitZ(), 1e-12)) << "right wing: down";
  EXPECT_TRUE((*q * Vec3::UnitZ()).isApprox(Vec3(-h, h, 0), 1e-12)) << "belly: north-west";
}

TEST(Orientation, NwuIsZUpAlready) {
  const auto q = q_level_from_imu(with_quaternion({1, 0, 0, 0}, CoordinateSystem::nwu));
  ASSERT_TRUE(q);
  expect_same_rotation(*q, Quaternion::Identity(), 1e-15);
}

TEST(Orientation, QuaternionIsPreferredToEulerAngles) {
  MtMeasurement m = with_euler({0, 0, 90});
  m.quaternion = with_quaternion({1, 0, 0, 0}).quaternion;
  m.add(MtItem::quaternion);
  expect_same_rotation(*q_level_from_imu(m), Quaternion::Identity(), 1e-12);
}

TEST(Orientation, WhatIsNoRotationIsNone) {
  EXPECT_FALSE(q_level_from_imu(MtMeasurement{}));
  EXPECT_FALSE(q_level_from_imu(with_quaternion({0, 0, 0, 0})));
  EXPECT_FALSE(q_level_from_imu(with_quaternion({1e-20, 0, 0, 0})));
  EXPECT_FALSE(q_level_from_imu(with_quaternion({3, 0, 0, 0})));
  EXPECT_FALSE(q_level_from_imu(with_quaternion({kNan, 0, 0, 1})));
  EXPECT_FALSE(q_level_from_imu(with_quaternion({kInf, 0, 0, 1})));
  EXPECT_FALSE(q_level_from_imu(with_euler({0, kNan, 0})));
  EXPECT_FALSE(q_level_from_imu(with_euler({-kInf, 0, 0})));
  EXPECT_FALSE(q_level_from_imu(with_matrix({})));
  EXPECT_FALSE(q_level_from_imu(with_matrix({1, 0, 0, 0, 1, 0, 0, 0, kNan})));
  EXPECT_FALSE(q_level_from_imu(with_matrix({1, 0, 0, 0, 1, 0, 0, 0, 1.1})));
  EXPECT_FALSE(q_level_from_imu(with_matrix({1, 0, 0, 0, 1, 0, 0, 0, -1}))) << "a mirror";
}

}  // namespace
}  // namespace convexcut::xsens
