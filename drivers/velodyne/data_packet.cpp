// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/data_packet.hpp"

#include "drivers/velodyne/model.hpp"
#include "drivers/velodyne/wire_layout.hpp"

namespace convexcut::velodyne {
namespace {

using namespace wire_layout;

// VLP-32A/B: not decoded, but its mode byte means the same.
constexpr std::uint8_t kProductVlp32ab = 0x23;

// Pairs in single mode need a rotor so slow that neighbours round to one azimuth; two of them are
// then less than this apart. The slowest specified rotor (5 Hz) turns 8 a block.
constexpr int kLeastPairStep = 3;  // 0.01°

bool mode_byte_is_plausible(wire::Bytes payload) noexcept {
  const std::uint8_t mode = wire::load_u8(payload, kReturnMode);
  const std::uint8_t id = product(payload);
  return (mode == kModeStrongest || mode == kModeLast || mode == kModeDual) &&
         (model_of_product(id).has_value() || id == kProductVlp32ab);
}

bool azimuths_come_in_pairs(wire::Bytes payload) noexcept {
  for (std::size_t block = 0; block < kBlocks; block += 2) {
    const int azimuth = block_azimuth(payload, block);
    if (block_azimuth(payload, block + 1) != azimuth) return false;
    if (block == 0) continue;
    const int step = (azimuth - block_azimuth(payload, block - 2) + kMaxAzimuth) % kMaxAzimuth;
    if (step < kLeastPairStep) return false;
  }
  return true;
}

}  // namespace

DecodeStatus check_data_packet(wire::Bytes payload) noexcept {
  if (payload.size() != kDataPacketSize) return DecodeStatus::wrong_length;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::size_t at = block * kBlockSize;
    if (wire::load_le<std::uint16_t>(payload, at + kBlockFlag) != kUpperBankFlag) {
      return DecodeStatus::wrong_block_flag;
    }
  }
  for (std::size_t block = 0; block < kBlocks; ++block) {
    if (block_azimuth(payload, block) > kMaxAzimuth) return DecodeStatus::azimuth_out_of_range;
  }
  if (wire::load_le<std::uint32_t>(payload, kDataTimestamp) > kMaxTimestamp) {
    return DecodeStatus::timestamp_out_of_range;
  }
  return DecodeStatus::ok;
}

bool has_dual_returns(wire::Bytes payload) noexcept {
  if (mode_byte_is_plausible(payload)) return wire::load_u8(payload, kReturnMode) == kModeDual;
  return azimuths_come_in_pairs(payload);
}

MicrosPastHour timestamp(wire::Bytes payload) noexcept {
  return {wire::load_le<std::uint32_t>(payload, kDataTimestamp) % kMicrosPerHour};
}

std::uint8_t product(wire::Bytes payload) noexcept { return wire::load_u8(payload, kProduct); }

std::uint16_t block_azimuth(wire::Bytes payload, std::size_t block) noexcept {
  return wire::load_le<std::uint16_t>(payload, block * kBlockSize + kBlockAzimuth);
}

}  // namespace convexcut::velodyne
