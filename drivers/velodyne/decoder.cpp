// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/decoder.hpp"

#include <algorithm>
#include <bit>
#include <span>

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

// One echo of slot `i`, as returns are appended one by one.
void append(const BlockReturns& from, std::size_t i, std::uint32_t offset_ns, std::uint32_t ring,
            Echo echo, bool farthest, ReturnBatch& out) noexcept {
  const std::size_t end = out.return_count++;
  out.x_lidar[end] = from.x_lidar[i];
  out.y_lidar[end] = from.y_lidar[i];
  out.z_lidar[end] = from.z_lidar[i];
  out.range_m[end] = from.range_m[i];
  out.offset_ns[end] = offset_ns;
  out.intensity[end] = from.intensity[i];
  out.ring[end] = static_cast<std::uint8_t>(ring);
  out.echo[end] = echo;
  out.farthest[end] = farthest;
}

}  // namespace

// A block, or in dual mode a pair of them, and where the rotor is during it.
struct DataDecoder::Block {
  wire::Bytes last;       // the only block, or the even one
  wire::Bytes strongest;  // the odd block
  std::int64_t azimuth_udeg = 0;
  std::int64_t step_udeg = 0;
  std::uint32_t start_ns = 0;

  [[nodiscard]] BlockSweep sweep() const noexcept {
    return {static_cast<double>(azimuth_udeg), static_cast<double>(step_udeg)};
  }
};

DataDecoder::DataDecoder(const Model& model, DecoderOptions options) noexcept
    : model_(model),
      max_step_(static_cast<std::int32_t>(kMaxRotorHz * kMaxAzimuth * model.block_period_ns() /
                                          1'000'000'000)) {
  slots_.metres_per_tick = model.distance_unit_mm * 1e-3;
  for (std::size_t i = 0; i < kReturnsPerBlock; ++i) {
    const std::size_t laser = i % model.lasers;
    const auto firing = static_cast<std::uint32_t>(i / model.lasers);
    slots_.time_ns[i] = firing * model.firing_period_ns + model.laser_time_ns(laser);
    share_q32_[i] =
        (slots_.time_ns[i] * kOneQ32 + model.block_period_ns() / 2) / model.block_period_ns();
    slots_.block_share[i] = static_cast<double>(share_q32_[i]) / static_cast<double>(kOneQ32);
    const SinCos elevation = sin_cos_mdeg(model.elevation_mdeg[laser]);
    slots_.cos_elevation[i] = elevation.cos;
    slots_.sin_elevation[i] = elevation.sin;
    if (options.vertical_offsets) {
      slots_.vertical_offset_m[i] = model.vertical_offset_um[laser] * 1e-6;
    }
    slots_.azimuth_offset_udeg[i] = model.azimuth_offset_mdeg[laser] * 1000;
    slots_.ring[i] = model.ring[laser];
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
    if constexpr (kDual) {
      decode_pair(block, out);
    } else {
      decode_single(block, out);
    }
  }
}

// Its azimuth to the nearest microdegree, as locate() has it of lasers.
Firing& DataDecoder::begin_firing(const Block& block, std::size_t first_slot,
                                  ReturnBatch& out) const noexcept {
  Firing& firing = out.firings[out.firing_count++];
  const std::int64_t turned = (block.step_udeg * share_q32_[first_slot] + kOneQ32 / 2) >> 32;
  firing.azimuth = Azimuth::from_microdegrees(block.azimuth_udeg + turned);
  firing.offset_ns = block.start_ns + slots_.time_ns[first_slot];
  firing.first_return = out.return_count;
  return firing;
}

void DataDecoder::decode_single(const Block& block, ReturnBatch& out) const noexcept {
  BlockReturns returns;
  locate(slots_, block.sweep(), block.last, returns);
  std::uint32_t next = out.return_count;
  const std::uint32_t echoes = append_echoes(slots_, returns, block.start_ns, out);
  std::fill(out.echo.begin() + next, out.echo.begin() + out.return_count, Echo::only);
  std::fill(out.farthest.begin() + next, out.farthest.begin() + out.return_count, true);
  const std::uint64_t of_a_firing = (std::uint64_t{1} << model_.lasers) - 1;
  for (std::size_t slot = 0; slot < kReturnsPerBlock; slot += model_.lasers) {
    Firing& firing = begin_firing(block, slot, out);
    const int count = std::popcount((echoes >> slot) & of_a_firing);
    firing.first_return = static_cast<std::uint16_t>(next);
    firing.return_count = static_cast<std::uint16_t>(count);
    next += firing.return_count;
  }
}

void DataDecoder::decode_pair(const Block& block, ReturnBatch& out) const noexcept {
  BlockReturns last;
  BlockReturns strongest;
  locate(slots_, block.sweep(), block.last, last);
  locate(slots_, block.sweep(), block.strongest, strongest);
  for (std::size_t slot = 0; slot < kReturnsPerBlock; slot += model_.lasers) {
    Firing& firing = begin_firing(block, slot, out);
    for (std::size_t i = slot; i < slot + model_.lasers; ++i) {
      const std::uint32_t offset_ns = block.start_ns + slots_.time_ns[i];
      const std::uint32_t ring = slots_.ring[i];
      const std::uint16_t a = last.ticks[i];
      const std::uint16_t b = strongest.ticks[i];
      if (a != 0 && b != 0 && a != b) {
        append(last, i, offset_ns, ring, Echo::last, a > b, out);
        append(strongest, i, offset_ns, ring, Echo::strongest, b > a, out);
      } else if (a != 0 || b != 0) {
        append(a != 0 ? last : strongest, i, offset_ns, ring, Echo::only, true, out);
      }
    }
    firing.return_count = static_cast<std::uint16_t>(out.return_count - firing.first_return);
  }
}

}  // namespace convexcut::velodyne
