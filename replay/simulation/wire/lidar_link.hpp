// SPDX-License-Identifier: Apache-2.0
//
// The network between a simulated HDL-32E and the host: packets become datagrams with arrival
// stamps, position packets come between them, and some get lost, doubled or overtaken.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/return_batch.hpp"
#include "core/scan/function_ref.hpp"
#include "core/time.hpp"
#include "drivers/capture/capture_writer.hpp"
#include "replay/simulation/random.hpp"
#include "replay/simulation/wire/hdl32e_packets.hpp"

namespace convexcut::simulation {

// Sunday 2026-03-01 09:59:58 UTC: the hour, where the lidar's counter wraps, comes 2 s later. What
// a simulation calls its start, on the host's clock.
inline constexpr HostTime kStart = from_ns<HostTime>(1'772'359'198'000'000'000);

struct LidarLinkOptions {
  // With PPS the lidar counts UTC; without, from when it was switched on.
  PpsState pps = PpsState::locked;
  Duration clock_offset{0};                         // of the lidar's counter, ahead of that
  Duration jitter = std::chrono::microseconds{40};  // of the arrival, on top of the shortest delay
  double loss = 0.0;                                // of data packets, shares
  double duplicate = 0.0;
  double reorder = 0.0;  // it comes after the one that follows it
};

struct Datagram {
  HostTime stamp{};
  std::uint16_t port = 0;  // source and destination
  std::span<const std::byte> payload;
};

class LidarLink {
 public:
  using Emit = FunctionRef<void(const Datagram&)>;

  LidarLink(const LidarLinkOptions& options, std::uint64_t seed, std::uint32_t stream)
      : options_(options), seed_(seed), stream_(stream) {}

  // What the sensor's counter says when it has counted `elapsed` since the start.
  [[nodiscard]] MicrosPastHour counter(Duration elapsed) const noexcept;

  // The packet that the sensor completes after `elapsed` by its own clock and `complete` by the
  // true one, both since the start. Its first_firing is set from `first_firing`, the sensor's
  // count. Datagrams are emitted in the order of their arrival.
  struct Moment {
    Duration first_firing{};  // sensor's clock
    Duration elapsed{};       // sensor's clock
    Duration complete{};      // true clock
  };
  void send(DataPacket& packet, const Moment& moment, Emit emit);
  // The packet that still waits to be overtaken, if any.
  void finish(Emit emit);

 private:
  void arrive(HostTime stamp, const DataPacketBytes& bytes, Random& random, Emit emit);
  void send_position(const Moment& moment, Random& random, Emit emit) const;
  [[nodiscard]] Duration jitter(Random& random) const noexcept;

  LidarLinkOptions options_;
  std::uint64_t seed_;
  std::uint32_t stream_;
  std::uint64_t packets_ = 0;
  Duration next_position_{};
  HostTime newest_{};  // stamp
  std::optional<DataPacketBytes> overtaken_;
};

// As a network capture has it: from the sensor's usual address, broadcast.
void write(const Datagram& datagram, capture::CaptureWriter& out);

}  // namespace convexcut::simulation
