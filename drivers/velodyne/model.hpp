// SPDX-License-Identifier: Apache-2.0
//
// What differs between the sensors that share the 1206-byte data packet: one row of numbers each.
// Sources: HDL-32E manual 63-9113 (p. 13, p. 27), VLP-16 manual 63-9243, and the calibration files
// of VeloView, which ROS, Nebula and PCL agree with.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "drivers/velodyne/wire_layout.hpp"

namespace convexcut::velodyne {

enum class ModelId : std::uint8_t { hdl32e, vlp16, puck_hires, vlp32c };

struct Model {
  static constexpr std::size_t kMaxLasers = wire_layout::kReturnsPerBlock;

  ModelId id = ModelId::hdl32e;
  std::string_view name;
  std::uint8_t product = 0;  // the data packet's last byte; not reliable

  std::uint8_t lasers = 0;             // that fire in one firing, in the order of the packet
  std::uint8_t firings_per_block = 0;  // lasers × firings_per_block = 32
  std::uint8_t lasers_at_once = 0;     // 2 where they fire in pairs
  std::uint8_t distance_unit_mm = 0;
  std::uint32_t laser_interval_ns = 0;  // from one laser (or pair) to the next
  std::uint32_t recharge_ns = 0;        // from the last interval's end to the next firing
  std::uint32_t firing_period_ns = 0;

  // By laser, in firing order; entries past `lasers` are 0.
  std::array<std::int32_t, kMaxLasers> elevation_mdeg{};
  std::array<std::int32_t, kMaxLasers> azimuth_offset_mdeg{};  // add to the rotor's azimuth
  // Height of the beam's origin over that of the sensor; beams do not all cross the axis there.
  std::array<std::int32_t, kMaxLasers> vertical_offset_um{};
  std::array<std::uint8_t, kMaxLasers> ring{};  // 0 = lowest elevation

  // When a laser fires, after the first of its firing.
  [[nodiscard]] constexpr std::uint32_t laser_time_ns(std::size_t laser) const noexcept {
    return laser_interval_ns * static_cast<std::uint32_t>(laser / lasers_at_once);
  }
  [[nodiscard]] constexpr std::uint32_t block_period_ns() const noexcept {
    return firing_period_ns * firings_per_block;
  }
  // The time that one packet covers: half the firings when each is reported twice.
  [[nodiscard]] constexpr std::uint32_t packet_period_ns(bool dual) const noexcept {
    return block_period_ns() * static_cast<std::uint32_t>(wire_layout::kBlocks) / (dual ? 2U : 1U);
  }
};

[[nodiscard]] const Model& model_of(ModelId id) noexcept;
[[nodiscard]] std::span<const Model> all_models() noexcept;
// Nothing for bytes that no known model sends.
[[nodiscard]] std::optional<ModelId> model_of_product(std::uint8_t product) noexcept;

}  // namespace convexcut::velodyne
