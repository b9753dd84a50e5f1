// SPDX-License-Identifier: Apache-2.0
//
// The courtyard recording as batches, read with the few lines that this one file needs (microsecond
// pcap, plain Ethernet, single return), so that the cutter is tested without the driver.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "drivers/wire.hpp"
#include "tests/core/scan/synthetic_lidar.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::test {

inline constexpr const char* kCourtyard = "lidar/hdl32e_courtyard_2011.pcap";

[[nodiscard]] inline TimedBatch decode_courtyard_packet(wire::Bytes payload) {
  TimedBatch timed;
  ReturnBatch& batch = timed.batch;
  timed.first_firing =
      LidarTime{std::chrono::microseconds{wire::load_le<std::uint32_t>(payload, 1200)}};
  batch.firing_period_ns = kFiringPeriodNs;
  for (std::size_t block = 0; block < 12; ++block) {
    const wire::Bytes bytes = payload.subspan(100 * block, 100);
    const auto azimuth = wire::load_le<std::uint16_t>(bytes, 2);
    add_firing(batch, Azimuth::from_centidegrees(azimuth), 0, 0);
    for (std::size_t laser = 0; laser < 32; ++laser) {
      const auto distance = wire::load_le<std::uint16_t>(bytes, 4 + 3 * laser);
      if (distance == 0) continue;
      const std::size_t i = batch.return_count++;
      ++batch.firings[block].return_count;
      batch.range_m[i] = static_cast<float>(distance) * 0.002F;
      batch.x_lidar[i] = batch.range_m[i];
      batch.y_lidar[i] = batch.z_lidar[i] = 0.0F;
      batch.offset_ns[i] =
          batch.firings[block].offset_ns + kLaserPeriodNs * static_cast<std::uint32_t>(laser);
      batch.intensity[i] = wire::load_u8(bytes, 6 + 3 * laser);
      batch.ring[i] = static_cast<std::uint8_t>(laser % 2 == 0 ? laser / 2 : 16 + laser / 2);
      batch.echo[i] = Echo::only;
      batch.farthest[i] = true;
    }
  }
  return timed;
}

[[nodiscard]] inline std::vector<TimedBatch> read_courtyard(const std::filesystem::path& file) {
  constexpr std::size_t kFileHeader = 24, kRecordHeader = 16, kNetworkHeaders = 42;
  const std::vector<std::byte> bytes = read_bytes(file);
  const wire::Bytes all(bytes);
  std::vector<TimedBatch> batches;
  for (std::size_t at = kFileHeader; at < all.size();) {
    const auto length = wire::load_le<std::uint32_t>(all, at + 8);
    batches.push_back(decode_courtyard_packet(
        all.subspan(at + kRecordHeader + kNetworkHeaders, length - kNetworkHeaders)));
    at += kRecordHeader + length;
  }
  return batches;
}

}  // namespace convexcut::test
