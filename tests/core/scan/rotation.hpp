// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/angle.hpp"
#include "core/geometry.hpp"

namespace convexcut::test {

// Degrees about x, y and z.
inline Quaternion rpy(double roll, double pitch, double yaw) {
  return to_quaternion({Degrees{roll}, Degrees{pitch}, Degrees{yaw}});
}

}  // namespace convexcut::test
