// SPDX-License-Identifier: Apache-2.0
//
// Datagrams of one lidar, live or from a capture → return batches in a sink.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/counter.hpp"
#include "core/return_batch.hpp"
#include "core/sink.hpp"
#include "core/time.hpp"
#include "drivers/ipv4_address.hpp"
#include "drivers/velodyne/decoder.hpp"
#include "drivers/velodyne/model.hpp"
#include "drivers/velodyne/model_detector.hpp"
#include "drivers/velodyne/position_packet.hpp"
#include "drivers/velodyne/wire_layout.hpp"
#include "drivers/wire.hpp"

namespace convexcut::velodyne {

struct LidarDriverOptions {
  std::optional<ModelId> model = std::nullopt;  // nothing: told from the first packets
  std::uint16_t data_port = wire_layout::kDataPort;
  std::uint16_t position_port = wire_layout::kPositionPort;
  bool vertical_offsets = false;  // see DecoderOptions
  Duration time_offset{0};        // added to the lidar's time, to the nearest microsecond
  std::optional<Ipv4Address> from = std::nullopt;  // datagrams of other senders are foreign
};

// What became of every datagram; readable from any thread. The first two groups add up to all the
// datagrams seen, less those still held until the model is known.
struct LidarCounters {
  // Good ones.
  Counter data_packets;      // decoded and handed to the sink
  Counter position_packets;  // decoded

  // Dropped, by reason.
  Counter foreign;  // another port, or another sender than the configured one
  Counter wrong_length;
  Counter wrong_block_flag;
  Counter azimuth_out_of_range;
  Counter timestamp_out_of_range;  // data and position packets
  Counter no_sentence;             // position packets that are none
  Counter model_unknown;           // good data packets whose model could not be told
  Counter sink_full;               // good data packets that the sink had no room for

  // Of the good ones.
  Counter returns;
  Counter product_differs;  // data packets with the product byte of another model, or of none
  Counter bad_nmea;         // position packets whose sentence is malformed or fails its checksum
};

// Tells data from position packets by destination port and length; never by the source port, which
// was 443 on early units.
//
// While the model is not known, the first data packets are held, and decoded when it is: none is
// lost. When eight packets do not tell it, they are dropped and the next eight are tried.
//
// Thread: on_datagram(), flush() and position() belong to one thread; the rest is for any. RT: no
// allocation, no lock, no system call after construction.
class LidarDriver {
 public:
  LidarDriver(const LidarDriverOptions& options, Sink<ReturnBatch>& sink) noexcept;

  // `arrival`: the kernel's or the capture's stamp. `source` matters only where a sender is
  // configured.
  void on_datagram(wire::Bytes payload, std::uint16_t destination_port, HostTime arrival,
                   Ipv4Address source = {}) noexcept;

  // At the end of the input: decides on the model with the packets there are and decodes them.
  void flush() noexcept;

  [[nodiscard]] const LidarCounters& counters() const noexcept { return counters_; }
  // The configured model or the one that was told; nothing until then.
  [[nodiscard]] std::optional<ModelId> model() const noexcept;
  // The latest good position packet.
  [[nodiscard]] const std::optional<PositionPacket>& position() const noexcept { return position_; }

 private:
  struct Held {
    std::array<std::byte, wire_layout::kDataPacketSize> payload;
    HostTime arrival;
    PpsState pps;
  };

  void on_data(wire::Bytes payload, HostTime arrival) noexcept;
  void on_position(wire::Bytes payload) noexcept;
  void count_rejected(DecodeStatus status) noexcept;
  void hold(wire::Bytes payload, HostTime arrival) noexcept;
  void release_held(std::optional<ModelId> model) noexcept;
  void set_model(ModelId id) noexcept;
  void decode(wire::Bytes payload, HostTime arrival, PpsState pps) noexcept;
  [[nodiscard]] PpsState pps() const noexcept;

  LidarDriverOptions options_;
  Sink<ReturnBatch>& sink_;
  std::uint32_t time_offset_us_;  // modulo the hour
  LidarCounters counters_;
  std::optional<DataDecoder> decoder_;
  std::atomic<int> model_{-1};  // ModelId, −1 = not known
  std::optional<PositionPacket> position_;
  ModelDetector detector_;
  std::size_t held_count_ = 0;
  std::array<Held, ModelDetector::kMaxPackets> held_{};
};

}  // namespace convexcut::velodyne
