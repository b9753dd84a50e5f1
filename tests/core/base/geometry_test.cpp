// SPDX-License-Identifier: Apache-2.0
#include "core/geometry.hpp"

#include <gtest/gtest.h>

namespace convexcut {
namespace {

TEST(RollPitchYaw, PositivePitchTurnsTheNoseDown) {
  const Quaternion q = to_quaternion({Degrees{0}, Degrees{90}, Degrees{0}});
  EXPECT_TRUE((q * Vec3::UnitX()).isApprox(-Vec3::UnitZ(), 1e-12));
}

TEST(RollPitchYaw, RollIsAppliedBeforeYaw) {
  const Quaternion q = to_quaternion({Degrees{90}, Degrees{0}, Degrees{90}});
  // y → z by the roll, and z stays under the yaw.
  EXPECT_TRUE((q * Vec3::UnitY()).isApprox(Vec3::UnitZ(), 1e-12));
  // x stays under the roll, and → y by the yaw.
  EXPECT_TRUE((q * Vec3::UnitX()).isApprox(Vec3::UnitY(), 1e-12));
}

TEST(RigidTransform, InverseUndoesAndCompositionChains) {
  const RigidTransform a_from_b{to_quaternion({Degrees{10}, Degrees{-20}, Degrees{30}}),
                                Vec3(1, 2, 3)};
  const RigidTransform b_from_c{to_quaternion({Degrees{-5}, Degrees{70}, Degrees{160}}),
                                Vec3(-4, 0, 9)};
  const Vec3 p_c(0.3, -7.0, 2.5);
  EXPECT_TRUE(((a_from_b * b_from_c) * p_c).isApprox(a_from_b * (b_from_c * p_c), 1e-12));
  EXPECT_TRUE((a_from_b.inverse() * (a_from_b * p_c)).isApprox(p_c, 1e-12));
}

}  // namespace
}  // namespace convexcut
