// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "drivers/live/file_descriptor.hpp"
#include "drivers/live/host_clock.hpp"
#include "drivers/wire.hpp"
#include "replay/feed/faults.hpp"

namespace convexcut::replay {

struct DatagramCounts {
  std::uint64_t sent = 0;  // of the sensor's, with duplicates, without garbage
  std::uint64_t lost = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;
  std::uint64_t garbage = 0;
  std::uint64_t not_sent = 0;  // the network would not take them
};

// A network between a sensor and this host's programs, as bad as it is asked to be. One thread.
class DatagramLink {
 public:
  using Time = live::Steady::time_point;

  // `address` is an IPv4 address: a host's, a broadcast or a group. Throws std::runtime_error.
  DatagramLink(const std::string& address, const Faults& faults, std::uint64_t seed);

  // The sensor sends now. Throws std::runtime_error when the very first datagram cannot be sent.
  void send(Time now, std::uint16_t port, wire::Bytes payload);
  // When something that was delayed is due.
  [[nodiscard]] std::optional<Time> next_due() const;
  void send_due(Time now);
  // Lets what is held back for reordering go.
  void release(Time now);

  [[nodiscard]] const DatagramCounts& counts() const noexcept { return counts_; }

 private:
  struct Waiting {
    Time due;
    std::uint16_t port = 0;
    std::vector<std::byte> payload;
    bool garbage = false;
  };

  void enqueue(Time now, Waiting datagram);
  void transmit(const Waiting& datagram);

  std::string address_;
  std::uint32_t address_be_ = 0;  // in network byte order
  Faults faults_;
  Dice dice_;
  live::FileDescriptor socket_;
  std::deque<Waiting> waiting_;
  std::optional<Waiting> held_;
  DatagramCounts counts_;
};

}  // namespace convexcut::replay
