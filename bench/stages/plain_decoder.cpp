// SPDX-License-Identifier: Apache-2.0
#include "bench/stages/plain_decoder.hpp"

#include <chrono>
#include <cmath>
#include <numbers>

#include "drivers/velodyne/wire_layout.hpp"

namespace convexcut::bench {
namespace {

using namespace velodyne::wire_layout;

constexpr float kFiringS = 46.08e-6F;
constexpr float kLaserS = 1.152e-6F;

}  // namespace

PlainDecoder::PlainDecoder() : model_(velodyne::model_of(velodyne::ModelId::hdl32e)) {
  constexpr double kRadiansPerMillidegree = std::numbers::pi / 180'000.0;
  for (int i = 0; i < kMaxAzimuth; ++i) {
    sines_.push_back(static_cast<float>(std::sin(10.0 * i * kRadiansPerMillidegree)));
    cosines_.push_back(static_cast<float>(std::cos(10.0 * i * kRadiansPerMillidegree)));
  }
  for (const std::int32_t mdeg : model_.elevation_mdeg) {
    elevation_sines_.push_back(static_cast<float>(std::sin(mdeg * kRadiansPerMillidegree)));
    elevation_cosines_.push_back(static_cast<float>(std::cos(mdeg * kRadiansPerMillidegree)));
  }
}

void PlainDecoder::decode(wire::Bytes packet, float start_s,
                          std::vector<PlainPoint>& points) const {
  float step = 0.0F;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const wire::Bytes bytes = packet.subspan(block * kBlockSize, kBlockSize);
    const int azimuth = wire::load_le<std::uint16_t>(bytes, kBlockAzimuth);
    if (block + 1 < kBlocks) {
      const int next =
          wire::load_le<std::uint16_t>(packet, (block + 1) * kBlockSize + kBlockAzimuth);
      step = static_cast<float>((next - azimuth + kMaxAzimuth) % kMaxAzimuth);
    }
    for (std::size_t laser = 0; laser < kReturnsPerBlock; ++laser) {
      const std::size_t at = kBlockReturns + laser * kReturnSize;
      const auto ticks = wire::load_le<std::uint16_t>(bytes, at + kReturnDistance);
      if (ticks == 0) continue;
      const auto in_block = static_cast<float>(laser) * kLaserS;
      const auto corrected = static_cast<std::size_t>(
          static_cast<int>(static_cast<float>(azimuth) + step * in_block / kFiringS + 0.5F) %
          kMaxAzimuth);
      const float range = static_cast<float>(ticks) * 0.002F;
      const float flat = range * elevation_cosines_[laser];
      PlainPoint point{};
      point.x = flat * cosines_[corrected];
      point.y = -flat * sines_[corrected];
      point.z = range * elevation_sines_[laser];
      point.intensity = static_cast<float>(wire::load_u8(bytes, at + kReturnIntensity));
      point.ring = model_.ring[laser];
      point.time_s = start_s + static_cast<float>(block) * kFiringS + in_block;
      points.push_back(point);
    }
  }
}

void level_plainly(std::span<PlainPoint> points, HostTime begin, const OrientationTrack& track) {
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  float firing_begin = -1.0F;
  for (PlainPoint& point : points) {
    if (point.time_s >= firing_begin + kFiringS || firing_begin < 0.0F) {
      firing_begin = std::floor(point.time_s / kFiringS) * kFiringS;
      const std::chrono::duration<float> after(firing_begin);
      const Orientation q = track.at(begin + std::chrono::duration_cast<Duration>(after));
      rotation = q.rotation.toRotationMatrix().cast<float>();
    }
    const Eigen::Vector3f p = rotation * Eigen::Vector3f(point.x, point.y, point.z);
    point.x = p.x();
    point.y = p.y();
    point.z = p.z();
  }
}

}  // namespace convexcut::bench
