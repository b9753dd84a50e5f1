// SPDX-License-Identifier: Apache-2.0
#include "bench/convex_cut/room_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace convexcut::bench {
namespace {

using Vector = std::array<double, 3>;

struct Box {
  Vector low;
  Vector high;
};

constexpr Box kRoom{{-4.2, -3.1, -1.1}, {4.8, 3.9, 1.7}};
constexpr std::array<Box, 7> kFurniture{{
    {{1.5, 1.0, -0.4}, {2.9, 1.8, -0.35}},    // table top
    {{-3.0, -2.9, -1.1}, {-1.2, -2.4, 0.9}},  // bookcase
    {{3.9, -2.0, -1.1}, {4.5, -0.6, 0.0}},    // cupboard
    {{-2.5, 1.2, -1.1}, {-2.0, 1.7, -0.2}},   // chair
    {{0.8, -2.2, -1.1}, {1.2, -1.9, 0.7}},    // standing person
    {{-0.6, 2.4, -1.1}, {0.9, 3.2, -0.3}},    // sofa
    {{-3.4, 0.2, -1.1}, {-3.1, 0.5, 1.7}},    // pillar
}};

// Where a ray from the origin enters and leaves a box: the parameter, and the side, two to an axis.
struct Crossing {
  double at;
  std::size_t side;
};

[[nodiscard]] std::array<Crossing, 2> cross(const Vector& direction, const Box& box) {
  Crossing enter{-std::numeric_limits<double>::infinity(), 0};
  Crossing leave{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Crossing low{box.low[axis] / direction[axis], 2 * axis};
    Crossing high{box.high[axis] / direction[axis], 2 * axis + 1};
    if (low.at > high.at) std::swap(low, high);
    if (low.at > enter.at) enter = low;
    if (high.at < leave.at) leave = high;
  }
  return {enter, leave};
}

// Sides are counted over all boxes.
[[nodiscard]] Crossing range_along(const Vector& direction) {
  Crossing nearest = cross(direction, kRoom)[1];
  for (std::size_t i = 0; i < kFurniture.size(); ++i) {
    const auto [enter, leave] = cross(direction, kFurniture[i]);
    if (enter.at <= 0.0 || enter.at >= leave.at || enter.at >= nearest.at) continue;
    nearest = {enter.at, 6 * (i + 1) + enter.side};
  }
  return nearest;
}

}  // namespace

RoomCloud room_cloud(std::size_t firings, double tilt_deg) {
  constexpr std::size_t kLasers = 32;
  constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
  // The same room in every run. NOLINTNEXTLINE(cert-msc32-c,cert-msc51-cpp)
  std::mt19937_64 random(1);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  const double tilt = tilt_deg * kRadiansPerDegree;
  RoomCloud cloud;
  for (std::size_t firing = 0; firing < firings; ++firing) {
    const double azimuth =
        2.0 * std::numbers::pi * static_cast<double>(firing) / static_cast<double>(firings);
    for (std::size_t laser = 0; laser < kLasers; ++laser) {
      const double elevation = (-92.0 + 4.0 * static_cast<double>(laser)) / 3.0 * kRadiansPerDegree;
      const Vector beam{std::cos(elevation) * std::cos(azimuth),
                        -std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      const Vector level{beam[0] * std::cos(tilt) + beam[2] * std::sin(tilt), beam[1],
                         beam[2] * std::cos(tilt) - beam[0] * std::sin(tilt)};
      // Box and Muller's normal deviate: the standard library's is not the same everywhere.
      const double noise = 0.02 * std::sqrt(-2.0 * std::log(1.0 - uniform())) *
                           std::cos(2.0 * std::numbers::pi * uniform());
      const Crossing hit = range_along(level);
      const double range = hit.at + noise;
      cloud.x.push_back(static_cast<float>(range * level[0]));
      cloud.y.push_back(static_cast<float>(range * level[1]));
      cloud.z.push_back(static_cast<float>(range * level[2]));
      cloud.side.push_back(static_cast<std::uint16_t>(hit.side));
    }
  }
  return cloud;
}

}  // namespace convexcut::bench
