// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/pose_file.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

namespace convexcut::recording {
namespace {

constexpr double kLengthTolerance = 1e-3;  // of a quaternion written with few digits

// "stamp_ns,x,y,z,qx,qy,qz,qw"; nothing: not eight numbers.
[[nodiscard]] std::optional<PoseSample> parse_pose(std::string_view line) {
  const char* const end = line.data() + line.size();
  std::int64_t stamp_ns = 0;
  auto [at, error] = std::from_chars(line.data(), end, stamp_ns);
  if (error != std::errc{}) return std::nullopt;
  std::array<double, 7> values{};
  for (double& value : values) {
    if (at == end || *at != ',') return std::nullopt;
    const auto [next, problem] = std::from_chars(at + 1, end, value);
    if (problem != std::errc{} || !std::isfinite(value)) return std::nullopt;
    at = next;
  }
  if (at != end) return std::nullopt;
  const auto& [x, y, z, qx, qy, qz, qw] = values;
  return PoseSample{from_ns<HostTime>(stamp_ns), Vec3(x, y, z), Quaternion(qw, qx, qy, qz)};
}

}  // namespace

std::vector<PoseSample> read_poses(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) {
    throw std::runtime_error("cannot open " + file.string() + ": " + std::strerror(errno));
  }
  std::vector<PoseSample> poses;
  std::string line;
  std::size_t number = 0;
  const auto wrong = [&](const std::string& what) {
    return std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + what);
  };
  while (std::getline(in, line)) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (number == 1) {
      if (line != kPoseFileHeader)
        throw wrong("expected the header " + std::string(kPoseFileHeader));
      continue;
    }
    auto pose = parse_pose(line);
    if (!pose) throw wrong("expected eight numbers: " + std::string(kPoseFileHeader));
    if (std::abs(pose->q_world_from_lidar.norm() - 1.0) > kLengthTolerance) {
      throw wrong("expected a rotation: qx, qy, qz, qw of length 1");
    }
    if (!poses.empty() && pose->stamp <= poses.back().stamp) {
      throw wrong("expected a later stamp_ns than in the line before");
    }
    pose->q_world_from_lidar.normalize();
    poses.push_back(*pose);
  }
  if (in.bad()) throw std::runtime_error(file.string() + ": cannot read it to its end");
  if (poses.empty())
    throw std::runtime_error(file.string() + ": no pose in it: expected at least one");
  return poses;
}

}  // namespace convexcut::recording
