// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a data packet: through the decoder of every model, and through the driver that has
// to tell the model first.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "drivers/velodyne/lidar_driver.hpp"

namespace {

using namespace convexcut;
using namespace convexcut::velodyne;

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const ReturnBatch& batch, const Model& model) {
  require(batch.return_count <= ReturnBatch::kMaxReturns);
  require(batch.firing_count >= 1 && batch.firing_count <= ReturnBatch::kMaxFirings);
  require(batch.first_firing.count < wire_layout::kMicrosPerHour);
  std::size_t next_return = 0;
  for (std::size_t i = 0; i < batch.firing_count; ++i) {
    const Firing& firing = batch.firings[i];
    require(firing.first_return == next_return);
    require(firing.offset_ns == i * batch.firing_period_ns);
    next_return += firing.return_count;
  }
  require(next_return == batch.return_count);
  for (std::size_t i = 0; i < batch.return_count; ++i) {
    const float range = batch.range_m[i];
    require(range > 0.0F && range < 263.0F);
    require(std::abs(batch.x_lidar[i]) <= range && std::abs(batch.y_lidar[i]) <= range);
    require(std::abs(batch.z_lidar[i]) <= range + 0.02F);
    require(batch.ring[i] < model.lasers);
    require(batch.offset_ns[i] < static_cast<std::uint64_t>(batch.span().count()));
    require(i == 0 || batch.offset_ns[i] >= batch.offset_ns[i - 1]);
    require(batch.farthest[i] || batch.echo[i] != Echo::only);
  }
}

class CheckingSink final : public Sink<ReturnBatch> {
 public:
  ReturnBatch* claim() noexcept override { return &slot_; }
  void commit() noexcept override { ++committed; }
  std::uint64_t committed = 0;

 private:
  ReturnBatch slot_;
};

// The same packet over and over, with the timestamps of an HDL-32E when it is long enough.
void drive(std::span<const std::byte> payload) {
  constexpr std::uint64_t kPackets = 10;
  CheckingSink sink;
  LidarDriver driver({.time_offset = Duration{-542'592}}, sink);
  std::vector<std::byte> packet(payload.begin(), payload.end());
  for (std::uint32_t n = 0; n < kPackets; ++n) {
    if (packet.size() == wire_layout::kDataPacketSize) {
      auto time = wire::load_le<std::uint32_t>(payload, wire_layout::kDataTimestamp);
      time += n * 553;
      std::memcpy(packet.data() + wire_layout::kDataTimestamp, &time, sizeof(time));
    }
    driver.on_datagram(packet, wire_layout::kDataPort, HostTime{});
  }
  driver.flush();
  const LidarCounters& counters = driver.counters();
  require(counters.data_packets.value() == sink.committed);
  require(counters.data_packets.value() + counters.wrong_length.value() +
              counters.wrong_block_flag.value() + counters.azimuth_out_of_range.value() +
              counters.timestamp_out_of_range.value() + counters.model_unknown.value() ==
          kPackets);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> payload = std::as_bytes(std::span(data, size));
  for (const Model& model : all_models()) {
    ReturnBatch batch;
    const DataDecoder decoder(model, {.vertical_offsets = true});
    if (decoder.decode(payload, HostTime{}, batch) == DecodeStatus::ok) check(batch, model);
  }
  drive(payload);
  return 0;
}
