// SPDX-License-Identifier: Apache-2.0
//
// A decoder as drivers commonly have it, the peer that the project's own is compared with: one
// point structure a return, sines and cosines from tables of 36 000 directions, one rotation matrix
// a firing. Single returns of an HDL-32E only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scan/orientation_track.hpp"
#include "core/time.hpp"
#include "drivers/velodyne/model.hpp"
#include "drivers/wire.hpp"

namespace convexcut::bench {

struct PlainPoint {
  float x, y, z;
  float intensity;
  std::uint16_t ring;
  float time_s;  // after the revolution's first firing
};

class PlainDecoder {
 public:
  PlainDecoder();
  // Appends the points of one data packet, frame lidar. start_s: of the packet's first firing.
  void decode(wire::Bytes packet, float start_s, std::vector<PlainPoint>& points) const;

 private:
  const velodyne::Model& model_;
  std::vector<float> sines_, cosines_;  // by azimuth, 0.01°
  std::vector<float> elevation_sines_, elevation_cosines_;
};

// Turns points that follow each other in time into frame level, each by the orientation at its
// firing.
void level_plainly(std::span<PlainPoint> points, HostTime begin, const OrientationTrack& track);

}  // namespace convexcut::bench
