// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/decoder.hpp"

#include <span>
#include <utility>

#include "core/angle.hpp"
#include "drivers/velodyne/sin_cos.hpp"
#include "drivers/velodyne/wire_layout.hpp"

namespace convexcut::velodyne {
namespace {

using namespace wire_layout;

// A rotor turns at 5 … 20 Hz; from here on its azimuths are not believed to be a rotation.
constexpr std::int64_t kMaxRotorHz = 30;

constexpr std::int64_t kOneQ32 = std::int64_t{1} << 32;

SinCos sin_cos_mdeg(std::int32_t millidegrees) noexcept {
  return sin_cos(Azimuth::from_microdegrees(std::int64_t{millidegrees} * 1000));
}

struct WireReturn {
  std::uint16_t ticks;
  std::uint8_t intensity;
};

WireReturn load_return(wire::Bytes block, std::size_t slot) noexcept {
  const std::size_t at = kBlockReturns + slot * kReturnSize;
  return {wire::load_le<std::uint16_t>(block, at + kReturnDistance),
          wire::load_u8(block, at + kReturnIntensity)};
}

// The line of a laser pulse: where its returns are, by range.
struct Beam {
  double x_per_range;
  double y_per_range;
  double z_per_range;
  double z_offset_m;
  std::uint32_t offset_ns;
  std::uint8_t ring;
};

void append(const Beam& beam, WireReturn wire_return, double metres_per_tick, Echo echo,
            bool farthest, ReturnBatch& out) noexcept {
  const double range = wire_return.ticks * metres_per_tick;
  const std::size_t i = out.return_count++;
  out.x_lidar[i] = static_cast<float>(range * beam.x_per_range);
  out.y_lidar[i] = static_cast<float>(range * beam.y_per_range);
  out.z_lidar[i] = static_cast<float>(range * beam.z_per_range + beam.z_offset_m);
  out.range_m[i] = static_cast<float>(range);
  out.offset_ns[i] = beam.offset_ns;
  out.intensity[i] = wire_return.intensity;
  out.ring[i] = beam.ring;
  out.echo[i] = echo;
  out.farthest[i] = farthest;
}

}  // namespace

// A block, or in dual mode a pair of them, and where the rotor is during it.
struct DataDecoder::Block {
  wire::Bytes last;       // the only block, or the even one
  wire::Bytes strongest;  // the odd block
  std::int64_t azimuth_udeg = 0;
  std::int64_t step_udeg = 0;
  std::uint32_t start_ns = 0;

  // To the nearest microdegree.
  [[nodiscard]] Azimuth rotor_at(const Slot& slot) const noexcept {
    const std::int64_t turned = (step_udeg * slot.block_share_q32 + kOneQ32 / 2) >> 32;
    return Azimuth::from_microdegrees(azimuth_udeg + turned);
  }
};

DataDecoder::DataDecoder(const Model& model, DecoderOptions options) noexcept
    : model_(model),
      metres_per_tick_(model.distance_unit_mm * 1e-3),
      max_step_(static_cast<std::int32_t>(kMaxRotorHz * kMaxAzimuth * model.block_period_ns() /
                                          1'000'000'000)) {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const std::size_t laser = i % model.lasers;
    const auto firing = static_cast<std::uint32_t>(i / model.lasers);
    Slot& slot = slots_[i];
    slot.time_ns = firing * model.firing_period_ns + model.laser_time_ns(laser);
    slot.block_share_q32 =
        (slot.time_ns * kOneQ32 + model.block_period_ns() / 2) / model.block_period_ns();
    const SinCos elevation = sin_cos_mdeg(model.elevation_mdeg[laser]);
    slot.cos_elevation = elevation.cos;
    slot.sin_elevation = elevation.sin;
    if (options.vertical_offsets) slot.vertical_offset_m = model.vertical_offset_um[laser] * 1e-6;
    slot.azimuth_offset_udeg = model.azimuth_offset_mdeg[laser] * 1000;
    slot.ring = model.ring[laser];
  }
}

DecodeStatus DataDecoder::decode(wire::Bytes payload, HostTime arrival,
                                 ReturnBatch& out) const noexcept {
  const DecodeStatus status = check_data_packet(payload);
  if (status != DecodeStatus::ok) return status;
  out.arrival = arrival;
  out.first_firing = timestamp(payload);
  out.firing_period_ns = model_.firing_period_ns;
  out.firing_count = 0;
  out.return_count = 0;
  if (has_dual_returns(payload)) {
    decode_blocks<true>(payload, out);
  } else {
    decode_blocks<false>(payload, out);
  }
  return DecodeStatus::ok;
}

template <bool kDual>
void DataDecoder::decode_blocks(wire::Bytes payload, ReturnBatch& out) const noexcept {
  constexpr std::size_t kStride = kDual ? 2 : 1;
  constexpr std::size_t kCount = kBlocks / kStride;
  std::array<std::uint16_t, kCount> azimuths{};
  for (std::size_t i = 0; i < kCount; ++i) azimuths[i] = block_azimuth(payload, i * kStride);
  const AzimuthSteps steps = azimuth_steps(azimuths, max_step_);
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::size_t at = i * kStride * kBlockSize;
    const Block block{
        .last = payload.subspan(at, kBlockSize),
        .strongest = payload.subspan(at + (kStride - 1) * kBlockSize, kBlockSize),
        .azimuth_udeg = std::int64_t{azimuths[i]} * Azimuth::kPerCentidegree,
        .step_udeg = std::int64_t{steps[i]} * Azimuth::kPerCentidegree,
        .start_ns = static_cast<std::uint32_t>(i) * model_.block_period_ns(),
    };
    for (std::size_t slot = 0; slot < kReturnsPerBlock; slot += model_.lasers) {
      decode_firing<kDual>(block, slot, out);
    }
  }
}

template <bool kDual>
void DataDecoder::decode_firing(const Block& block, std::size_t first_slot,
                                ReturnBatch& out) const noexcept {
  Firing& firing = out.firings[out.firing_count++];
  firing.azimuth = block.rotor_at(slots_[first_slot]);
  firing.offset_ns = block.start_ns + slots_[first_slot].time_ns;
  firing.first_return = out.return_count;
  for (std::size_t i = first_slot; i < first_slot + model_.lasers; ++i) {
    WireReturn last = load_return(block.last, i);
    WireReturn strongest{};
    if constexpr (kDual) {
      strongest = load_return(block.strongest, i);
      if (last.ticks == 0) std::swap(last, strongest);
      if (strongest.ticks == last.ticks) strongest.ticks = 0;
    }
    if (last.ticks == 0) continue;

    const Slot& slot = slots_[i];
    const SinCos azimuth = sin_cos(Azimuth::from_microdegrees(
        std::int64_t{block.rotor_at(slot).microdegrees()} + slot.azimuth_offset_udeg));
    const Beam beam{.x_per_range = slot.cos_elevation * azimuth.cos,
                    .y_per_range = -slot.cos_elevation * azimuth.sin,
                    .z_per_range = slot.sin_elevation,
                    .z_offset_m = slot.vertical_offset_m,
                    .offset_ns = block.start_ns + slot.time_ns,
                    .ring = slot.ring};
    if (!kDual || strongest.ticks == 0) {
      append(beam, last, metres_per_tick_, Echo::only, true, out);
    } else {
      append(beam, last, metres_per_tick_, Echo::last, last.ticks > strongest.ticks, out);
      append(beam, strongest, metres_per_tick_, Echo::strongest, strongest.ticks > last.ticks, out);
    }
  }
  firing.return_count = static_cast<std::uint16_t>(out.return_count - firing.first_return);
}

}  // namespace convexcut::velodyne
