// SPDX-License-Identifier: Apache-2.0
//
// From the configuration's words to the pipeline's options.
#include <algorithm>

#include "daemon/pipeline/pipeline.hpp"

namespace convexcut::daemon {
namespace {

[[nodiscard]] CutOptions cut_options(const config::Lidar& lidar, const config::Worker& worker) {
  CutOptions cut;
  cut.mode =
      lidar.cut == config::CutMode::clock ? CutOptions::Mode::clock : CutOptions::Mode::revolution;
  cut.cut_azimuth = Azimuth::from_degrees(lidar.cut_azimuth);
  cut.window = std::chrono::milliseconds{worker.period_ms};
  cut.min_range_m = lidar.min_range_m;
  cut.max_range_m = lidar.max_range_m;
  switch (lidar.dual_return) {
    case config::DualReturn::farthest:
      cut.echoes = CutOptions::Echoes::farthest;
      break;
    case config::DualReturn::last:
      cut.echoes = CutOptions::Echoes::last;
      break;
    case config::DualReturn::strongest:
      cut.echoes = CutOptions::Echoes::strongest;
      break;
    case config::DualReturn::both:
      cut.echoes = CutOptions::Echoes::both;
      break;
  }
  return cut;
}

[[nodiscard]] StageUse stage_use(config::EncoderUse use) {
  switch (use) {
    case config::EncoderUse::yaw:
      return StageUse::heading;
    case config::EncoderUse::orientation:
      return StageUse::orientation;
    case config::EncoderUse::off:
      break;
  }
  return StageUse::none;
}

}  // namespace

PipelineOptions pipeline_options(const config::Config& config, unsigned threads) {
  PipelineOptions options;
  options.cut = cut_options(config.lidar, config.worker);
  options.convex_cut.planes = config.convex_cut.planes;
  options.convex_cut.half_width_m = config.convex_cut.half_width_m;
  options.convex_cut.hull_distance_m = config.convex_cut.hull_distance_m;
  options.method = config.convex_cut.method;
  options.robust.window = config.convex_cut.window;
  options.learn_first = config.convex_cut.learn_first;
  options.robust.band_m = static_cast<float>(config.convex_cut.band_m);
  options.threads = threads != 0 ? threads : config.convex_cut.threads;
  options.fixed_mount = config.mount.orientation == config::MountOrientation::fixed;
  options.q_level_from_lidar =
      to_quaternion({config.mount.roll, config.mount.pitch, config.mount.yaw});
  options.q_imu_from_lidar =
      to_quaternion({config.imu.mount_roll, config.imu.mount_pitch, config.imu.mount_yaw});
  options.orientation_max_age = std::chrono::milliseconds{config.imu.max_age_ms};
  options.stage_use = stage_use(config.encoder.use);
  options.stage_axis =
      config.encoder.axis == config::EncoderAxis::tilt ? StageAxis::tilt : StageAxis::rotation;
  options.stage_max_age = std::chrono::milliseconds{config.encoder.timeout_ms};
  options.orientation_wait = options.orientation_max_age;
  if (options.stage_use != StageUse::none) {
    options.orientation_wait = std::max(options.orientation_wait, options.stage_max_age);
  }
  return options;
}

}  // namespace convexcut::daemon
