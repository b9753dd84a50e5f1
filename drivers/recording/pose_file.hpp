// SPDX-License-Identifier: Apache-2.0
//
// Poses as text: the header "stamp_ns,x,y,z,qx,qy,qz,qw", then one pose a line: nanoseconds of the
// Unix epoch, metres, and the rotation from lidar to world as a quaternion of length 1 ± 0.001.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/pose_sample.hpp"

namespace convexcut::recording {

inline constexpr std::string_view kPoseFileHeader = "stamp_ns,x,y,z,qx,qy,qz,qw";

// At least one pose, with ascending stamps; rotations are normalised. Throws std::runtime_error of
// one line that names the file, the line and what was expected.
[[nodiscard]] std::vector<PoseSample> read_poses(const std::filesystem::path& file);

}  // namespace convexcut::recording
