// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "replay/simulation/random.hpp"

namespace convexcut::simulation {

// The bytes that one read() of a serial port returned, and when it did.
struct SerialRead {
  HostTime stamp{};
  std::span<const std::byte> bytes;
};

// A serial line between a device and a host that reads it at uneven times: a read takes what has
// arrived until then, so that messages come in pieces and pieces of two messages come together.
class SerialLine {
 public:
  explicit SerialLine(std::uint32_t baud) : baud_(baud) {}

  // The device starts to send at `begin`, or when the line has become free.
  void send(HostTime begin, std::span<const std::byte> bytes);

  // All that was sent, in order. No byte is read before its last bit was on the line. The bytes
  // belong to the line.
  [[nodiscard]] std::vector<SerialRead> reads(Random& random) const;

 private:
  std::uint32_t baud_;
  std::vector<std::byte> bytes_;
  std::vector<HostTime> arrivals_;  // of each byte
};

}  // namespace convexcut::simulation
