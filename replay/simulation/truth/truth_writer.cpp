// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/truth/truth_writer.hpp"

#include <array>
#include <bit>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include <toml++/toml.h>

#include "core/angle.hpp"
#include "drivers/wire.hpp"
#include "replay/simulation/truth/label_name.hpp"
#include "replay/simulation/truth/truth_format.hpp"
#include "replay/text.hpp"

namespace convexcut::simulation {
namespace {

namespace format = truth_format;

constexpr std::size_t kBufferSize = std::size_t{1} << 20;

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string header(std::size_t echoes, std::uint64_t firings) {
  std::array<std::byte, format::kHeaderSize> bytes{};
  std::memcpy(bytes.data() + format::kMagicOffset, format::kMagic.data(), format::kMagic.size());
  wire::store_le<std::uint32_t>(bytes, format::kVersionOffset, format::kVersion);
  wire::store_le<std::uint32_t>(bytes, format::kHeaderSizeOffset, format::kHeaderSize);
  wire::store_le<std::uint32_t>(bytes, format::kRecordSizeOffset,
                                static_cast<std::uint32_t>(format::record_size(echoes)));
  wire::store_le<std::uint16_t>(bytes, format::kEchoesOffset, static_cast<std::uint16_t>(echoes));
  wire::store_le<std::uint16_t>(bytes, format::kLasersOffset, format::kLasers);
  wire::store_le<std::uint64_t>(bytes, format::kFiringsOffset, firings);
  return std::string(as_text(bytes));
}

void store(const SimulatedReturn& truth, wire::WritableBytes out) {
  wire::store_le<std::uint16_t>(out, format::kRangeOffset, truth.range_2mm);
  wire::store_le<std::uint32_t>(out, format::kTrueRangeOffset,
                                std::bit_cast<std::uint32_t>(truth.true_range_m));
  wire::store_le<std::uint8_t>(out, format::kLabelOffset, static_cast<std::uint8_t>(truth.label));
  wire::store_le<std::uint8_t>(out, format::kFlagsOffset, truth.flags);
  wire::store_le<std::uint16_t>(out, format::kSurfaceOffset, truth.surface);
}

toml::table scene_table(const Scene& scene) {
  toml::table table;
  table.insert("name", scene.name());
  toml::array surfaces;
  for (const SurfaceInfo& surface : scene.surfaces()) {
    surfaces.push_back(toml::table{{"name", surface.name},
                                   {"label", std::string(name_of(surface.label))},
                                   {"material", std::string(name_of(surface.material))},
                                   {"reflectivity", surface.reflectivity}});
  }
  table.insert("surface", std::move(surfaces));
  return table;
}

toml::table lidar_table(const LidarOptions& lidar, const LidarLinkOptions& link) {
  return toml::table{{"rotor_hz", lidar.rotor_hz},
                     {"start_azimuth_deg", lidar.start_azimuth.value},
                     {"noise_m", lidar.noise_m},
                     {"min_range_m", lidar.min_range_m},
                     {"max_range_m", lidar.max_range_m},
                     {"divergence_rad", lidar.divergence.value},
                     {"pulse_length_m", lidar.pulse_length_m},
                     {"dropout", lidar.dropout},
                     {"attenuation", lidar.attenuation},
                     {"ghosts", lidar.ghosts},
                     {"dual", lidar.dual},
                     {"clock_fast_by_ppm", lidar.clock.fast_by_ppm},
                     {"clock_offset_ns", link.clock_offset.count()},
                     {"pps", link.pps == PpsState::locked},
                     {"jitter_ns", link.jitter.count()},
                     {"loss", link.loss},
                     {"duplicate", link.duplicate},
                     {"reorder", link.reorder}};
}

toml::table rig_table(const RigOptions& rig) {
  return toml::table{{"yaw_deg", rig.yaw.value},
                     {"rotation_dps", rig.rotation_per_second.value},
                     {"tilt_deg", rig.tilt.value},
                     {"tilt_swing_deg", rig.tilt_swing.value},
                     {"tilt_swing_hz", rig.tilt_swing_hz},
                     {"sway_deg", rig.sway.value},
                     {"sway_m", rig.sway_m}};
}

toml::table imu_table(const SimulationOptions& options) {
  const ImuErrors& errors = options.imu_errors;
  return toml::table{{"rate_hz", options.serial_imu.rate_hz},
                     {"baud", std::int64_t{options.serial_imu.baud}},
                     {"clock_fast_by_ppm", options.serial_imu.clock.fast_by_ppm},
                     {"can_rate_hz", options.can_imu.rate_hz},
                     {"tilt_error_deg", errors.tilt.value},
                     {"wander_deg", errors.wander.value},
                     {"gravity_error_deg", errors.gravity.value},
                     {"rate_noise_rad_s", options.serial_imu.noise.rate_of_turn_rad_s},
                     {"acceleration_noise_m_s2", options.serial_imu.noise.acceleration_m_s2},
                     {"rate_bias_rad_s", errors.rate_bias_rad_s},
                     {"acceleration_bias_m_s2", errors.acceleration_bias_m_s2}};
}

}  // namespace

ReturnsWriter::ReturnsWriter(std::filesystem::path file, bool dual, std::uint64_t firings)
    : out_(std::move(file)), echoes_(dual ? 2 : 1), buffer_(header(echoes_, firings)) {
  buffer_.reserve(kBufferSize + format::record_size(echoes_));
}

void ReturnsWriter::write(const SimulatedFiring& firing) {
  std::array<std::byte, format::record_size(SimulatedFiring::kMaxEchoes)> bytes{};
  const wire::WritableBytes record(bytes);
  wire::store_le<std::int64_t>(record, format::kTimeOffset, to_ns(kStart + firing.since_start));
  wire::store_le<std::uint16_t>(
      record, format::kAzimuthOffset,
      static_cast<std::uint16_t>(firing.azimuth.microdegrees() / Azimuth::kPerCentidegree));
  std::size_t at = format::kReturnsOffset;
  for (std::size_t echo = 0; echo < echoes_; ++echo) {
    for (const SimulatedReturn& truth : firing.returns[echo]) {
      store(truth, record.subspan(at, format::kReturnSize));
      at += format::kReturnSize;
    }
  }
  buffer_ += as_text(record.first(at));
  if (buffer_.size() >= kBufferSize) flush();
}

void ReturnsWriter::flush() {
  out_.write(buffer_);
  buffer_.clear();
}

void ReturnsWriter::finish() {
  flush();
  out_.commit();
}

void write_poses(const SimulationOptions& options, const std::filesystem::path& file) {
  replay::AtomicFile out(file);
  const RigMotion motion(options.rig, options.seed);
  const Period period = options.imu_period();
  std::string text = std::string(format::kPosesHeader) + '\n';
  for (Duration t{0}; t <= period.length; t += format::kPosePeriod) {
    const auto& [p, q] = motion.pose_at(period.from + t);
    text += replay::format("%lld,%.9f,%.9f,%.9f,%.12f,%.12f,%.12f,%.12f\n",
                           static_cast<long long>(to_ns(kStart + period.from + t)), p.x(), p.y(),
                           p.z(), q.x(), q.y(), q.z(), q.w());
  }
  out.write(text);
  out.commit();
}

void write_settings(const Scene& scene, const SimulationOptions& options,
                    const std::filesystem::path& file) {
  const toml::table settings{{"format", format::kVersion},
                             {"scene", scene_table(scene)},
                             {"seed", static_cast<std::int64_t>(options.seed)},
                             {"start_ns", to_ns(kStart)},
                             {"length_ns", options.length.count()},
                             {"rig", rig_table(options.rig)},
                             {"lidar", lidar_table(options.lidar, options.link)},
                             {"imu", imu_table(options)}};
  std::ostringstream text;
  text << settings << '\n';
  replay::AtomicFile out(file);
  out.write(text.str());
  out.commit();
}

}  // namespace convexcut::simulation
