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
#include "replay/simulation/rig/rig_motion.hpp"
#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {

struct Column {
  static constexpr std::size_t kLasers = SimulatedFiring::kLasers;
  static constexpr std::int64_t kUnknown = -1'000'000;

  std::int64_t firing = kUnknown;
  std::array<Ray, kLasers> rays;  // in firing order
  std::array<Hit, kLasers> hits;
  std::array<Vec3, kLasers> points;  // the hits' places
  std::bitset<kLasers> met;
};

// Where a ray meets a plane, along its direction; meaningless for one that is parallel.
[[nodiscard]] inline double distance_to_plane(const Ray& ray, const Vec3& normal,
                                              const Vec3& point) noexcept {
  return normal.dot(point - ray.origin) / normal.dot(ray.direction);
}
inline constexpr double kUnknownDistance = -1.0;

// SceneAt::cast, faster where the distance is what was expected.
bool cast_expecting(const SceneAt& scene, const Ray& ray, double distance_m, Hit& hit) noexcept;

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
  // The scene that the column was cast in; of the columns that are kept.
  [[nodiscard]] const SceneAt& scene_of(const Column& column) const noexcept {
    return scenes_[static_cast<std::size_t>(scene_step(column.firing) & 1)];
  }

 private:
  struct Place {
    Vec3 position_world = Vec3::Zero();
    Eigen::Matrix3d world_from_lidar = Eigen::Matrix3d::Identity();
  };

  // Movers are placed anew every eight firings: 369 µs, in which somebody who walks goes 0.5 mm.
  static constexpr std::int64_t kFiringsPerSceneStep = 8;
  [[nodiscard]] static std::int64_t scene_step(std::int64_t firing) noexcept {
    return (firing + kFiringsPerSceneStep) / kFiringsPerSceneStep;  // firing ≥ −1
  }

  [[nodiscard]] std::int64_t azimuth_step(std::int64_t firing) const noexcept;
  [[nodiscard]] Place place(std::int64_t firing) const noexcept;
  void aim(Column& column);
  void cast(Column& column);

  RigMotion motion_;
  DeviceClock clock_;
  bool dual_;
  double centidegrees_per_firing_;
  double first_centidegrees_;
  std::array<SceneAt, 2> scenes_;
  std::array<std::int64_t, 2> scene_steps_{-1, -1};
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
