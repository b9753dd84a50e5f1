// SPDX-License-Identifier: Apache-2.0
//
// The middle rays of a firing's beams, and what they meet.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>

#include "core/angle.hpp"
#include "core/time.hpp"
#include "replay/simulation/lidar/lidar_options.hpp"
#include "replay/simulation/lidar/simulated_firing.hpp"
#include "replay/simulation/lidar/surroundings.hpp"
#include "replay/simulation/rig/rig_motion.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {

struct Column {
  static constexpr std::size_t kLasers = SimulatedFiring::kLasers;
  static constexpr std::int64_t kUnknown = -1'000'000;

  std::int64_t firing = kUnknown;
  const Surroundings* around = nullptr;  // that it was cast in
  std::array<Ray, kLasers> rays;         // in firing order
  std::array<Hit, kLasers> hits;
  std::array<Vec3, kLasers> points;  // the hits' places
  std::bitset<kLasers> met;
};

// When a firing is, where the rotor is then, and the columns of three firings in a row. One thread.
class ColumnCaster {
 public:
  static constexpr Duration kFiringPeriod{46'080};  // by the sensor's clock

  ColumnCaster(const Scene& scene, const RigMotion& motion, const LidarOptions& options);

  [[nodiscard]] std::int64_t firings_per_packet() const noexcept { return dual_ ? 6 : 12; }
  // True time since the start.
  [[nodiscard]] Duration time_of(std::int64_t firing) const noexcept;
  // As on the wire: the encoder counts hundredths of a degree.
  [[nodiscard]] Azimuth rotor(std::int64_t firing) const noexcept;

  // Stays until the column three firings before or behind it is asked for.
  const Column& column(std::int64_t firing);

 private:
  struct Place {
    Vec3 position_world = Vec3::Zero();
    Eigen::Matrix3d world_from_lidar = Eigen::Matrix3d::Identity();
  };

  static constexpr std::int64_t kFiringsPerBlock = Surroundings::kFirings;
  // The firings that have their surroundings in common.
  struct Block {
    std::int64_t number = -1;
    Surroundings around;
    Surroundings::Rays rays;
  };
  [[nodiscard]] static std::int64_t block_of(std::int64_t firing) noexcept {
    return (firing + kFiringsPerBlock) / kFiringsPerBlock;  // firing ≥ −1
  }

  [[nodiscard]] std::int64_t azimuth_step(std::int64_t firing) const noexcept;
  [[nodiscard]] Place place(std::int64_t firing) const noexcept;
  const Block& block(std::int64_t number);
  void aim(std::int64_t firing, std::array<Ray, Column::kLasers>& rays);
  static void cast(Column& column);

  RigMotion motion_;
  DeviceClock clock_;
  bool dual_;
  double centidegrees_per_firing_;
  double first_centidegrees_;
  std::array<Block, 2> blocks_;
  struct Elevation {
    double cos = 1.0;
    double sin = 0.0;
  };
  std::array<Elevation, Column::kLasers> elevation_{};     // in firing order
  std::array<std::int64_t, Column::kLasers> share_q32_{};  // of the firing period that has passed
  std::array<Column, 3> columns_;
  std::int64_t placed_firing_ = Column::kUnknown;
  Place placed_;
};

}  // namespace convexcut::simulation
