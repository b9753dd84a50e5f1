// SPDX-License-Identifier: Apache-2.0
//
// Where a revolution was taken: frame level, as the IMU gives it, in the frame of the window. The
// IMU's vertical and heading are wrong by some tenths of a degree that turn with the stage, or by
// degrees for good; and a rig may move.
#pragma once

#include "core/cloud.hpp"
#include "core/convex_cut/robust/moments.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"
#include "core/geometry.hpp"

namespace convexcut::robust {

struct RigPose {
  Mat3f r_window_from_level = Mat3f::Identity();
  Vec3f position = Vec3f::Zero();  // metres, in the middle of the revolution
  Vec3f step = Vec3f::Zero();      // metres from the start of the revolution to its end

  // share: of the revolution's time, 0 … 1.
  [[nodiscard]] Vec3f apply(const Vec3f& p_level, float share) const noexcept {
    return r_window_from_level * p_level + position + (share - 0.5F) * step;
  }
};

[[nodiscard]] inline Vec3f point_of(const CloudView& cloud, std::size_t i) noexcept {
  return {cloud.x[i], cloud.y[i], cloud.z[i]};
}

// The rotation that makes floor and walls of a revolution level and upright: the direction to which
// most surfaces are square or along, where it explains clearly more than z does. At most 12°.
[[nodiscard]] Mat3f upright_correction(const VoxelMap& revolution) noexcept;

// The rotation about the vertical that lays most walls along x and y, by at most 45°: voxels that
// walls cross askew hold less of them, and that a room is askew to the IMU's axes is chance.
[[nodiscard]] Mat3f wall_correction(const VoxelMap& revolution,
                                    const Mat3f& r_upright_from_level) noexcept;

}  // namespace convexcut::robust
