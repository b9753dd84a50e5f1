// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/ipv4_address.hpp"
#include "drivers/live/drop_count.hpp"
#include "drivers/live/file_descriptor.hpp"

namespace convexcut::udp {

struct UdpSocketOptions {
  // Nothing: all of the host's, which is what broadcast needs. It need not be the host's yet
  // (IP_FREEBIND).
  std::optional<Ipv4Address> local_address = std::nullopt;
  std::optional<Ipv4Address> multicast_group = std::nullopt;
  // Only what comes in here is received, and the group is joined here; empty: any interface.
  std::string interface {};
  std::size_t receive_buffer_bytes = std::size_t{8} << 20U;
};

// What the kernel says of an interface.
struct InterfaceState {
  int index = 0;    // 0: there is none of this name
  bool up = false;  // up, and with a carrier
};

// One UDP port, set up for a lidar: shared port, kernel stamps, drop count, large receive buffer.
// One thread. RT: no allocation.
class UdpSocket {
 public:
  // Opens and binds. Returns 0 or errno; the socket is closed then.
  [[nodiscard]] int open(const UdpSocketOptions& options, std::uint16_t port) noexcept;
  void close() noexcept;

  [[nodiscard]] int fd() const noexcept { return fd_.get(); }
  // What the kernel granted, in the unit of the option: bytes of datagrams and their book-keeping.
  [[nodiscard]] std::size_t receive_buffer_bytes() const noexcept { return receive_buffer_bytes_; }

  // 0 or errno. Joining a group twice is no error.
  [[nodiscard]] int join(Ipv4Address group, int interface_index) noexcept;
  [[nodiscard]] InterfaceState interface_state(const std::string& interface) const noexcept;

  // How many datagrams the kernel dropped for want of room since the last call: from the count
  // that came with a datagram, or as it is now.
  [[nodiscard]] std::uint32_t new_drops(std::uint32_t count) noexcept {
    return drops_.advance(count);
  }
  [[nodiscard]] std::uint32_t new_drops() noexcept;

 private:
  [[nodiscard]] int set_up(const UdpSocketOptions& options, std::uint16_t port) noexcept;
  void set_receive_buffer(std::size_t bytes) noexcept;

  live::FileDescriptor fd_;
  live::DropCount drops_;
  std::size_t receive_buffer_bytes_ = 0;
};

}  // namespace convexcut::udp
