// SPDX-License-Identifier: Apache-2.0
//
// What comes back of a laser pulse: one echo for each surface that a ray meets, directly, through
// glass or by mirrors; and the pulses that a receiver makes of the echoes of a beam of many rays.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "replay/simulation/lidar/column.hpp"
#include "replay/simulation/lidar/lidar_options.hpp"
#include "replay/simulation/lidar/surroundings.hpp"
#include "replay/simulation/scene/ray.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {

struct Echo {
  double range_m = 0.0;     // length of the path
  double energy = 0.0;      // of the peak; 1: a white surface at 1 m, seen at a right angle
  double brightness = 0.0;  // reflectivity as the sensor reports it, 0 … 1
  std::uint32_t surface = kNoSurface;
  SurfaceLabel label = SurfaceLabel::none;
  std::uint8_t flags = 0;
};

// A list that never allocates: what does not fit any more is the weakest light, and is left out.
class Echoes {
 public:
  void clear() noexcept { count_ = 0; }
  void add(const Echo& echo) noexcept {
    if (count_ < echoes_.size()) echoes_[count_++] = echo;
  }
  [[nodiscard]] std::span<Echo> all() noexcept { return std::span(echoes_).first(count_); }

 private:
  std::array<Echo, 40> echoes_;
  std::size_t count_ = 0;
};

// What a column's middle rays send back where they meet diffuse surfaces and stand for the whole
// beam, which is nearly everywhere: all at once, several to an instruction.
struct PlainEchoes {
  using Numbers = Eigen::Array<double, Column::kLasers, 1>;
  Numbers energy;
  Numbers brightness;
  Numbers seen;                           // how probably
  std::bitset<Column::kLasers> is_plain;  // false: nothing, glass or a mirror is met
};

class Optics {
 public:
  Optics(const Scene& scene, const LidarOptions& options);

  // Adds the echoes of a ray of the laser's beam, whose first hit is known, with `weight` of the
  // pulse's energy.
  void trace(const Surroundings& around, std::size_t laser, const Ray& ray, const Hit& hit,
             double weight, Echoes& echoes) const noexcept;

  void scatter(const Column& column, PlainEchoes& out) const noexcept;
  // The one of a laser for which is_plain is true.
  [[nodiscard]] Echo plain_echo(const Column& column, const PlainEchoes& all,
                                std::size_t laser) const noexcept {
    const auto i = static_cast<Eigen::Index>(laser);
    const Hit& hit = column.hits[laser];
    return {.range_m = hit.distance_m,
            .energy = all.energy[i],
            .brightness = all.brightness[i],
            .surface = hit.surface,
            .label = surfaces_[hit.surface].label};
  }

  // How probably a pulse is seen.
  [[nodiscard]] static double seen_probability(double energy) noexcept;

  // Sorts the echoes by range and joins those within a pulse length, each group to its weighted
  // mean, in place; how many pulses there are.
  [[nodiscard]] std::size_t join(Echoes& echoes) const noexcept;

 private:
  struct Light {
    double travelled_m = 0.0;
    double energy = 0.0;  // share that is left, both ways
    std::uint8_t flags = 0;
    std::uint32_t mirror = kNoSurface;  // the first one on the way
    int turns = 0;                      // surfaces that it has passed
    std::size_t laser = 0;              // in whose beam it is until it is mirrored
  };
  void follow(const Surroundings& around, const Ray& ray, const Hit& hit, const Light& light,
              Echoes& echoes) const noexcept;
  void cast_on(const Surroundings& around, const Ray& ray, const Light& light,
               Echoes& echoes) const noexcept;
  [[nodiscard]] Echo scattered(const Hit& hit, double cosine, const Light& light) const noexcept;

  std::span<const SurfaceInfo> surfaces_;  // of the scene
  Scene scene_;                            // keeps them
  double stretch_;                         // of a pulse on a slant, a metre of range
  double pulse_length_m_;
};

}  // namespace convexcut::simulation
