// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <netinet/in.h>
#include <sys/socket.h>

#include "core/time.hpp"
#include "drivers/ipv4_address.hpp"
#include "drivers/live/ancillary.hpp"
#include "drivers/wire.hpp"

namespace convexcut::udp {

struct Datagram {
  wire::Bytes payload;
  bool truncated = false;  // it was longer than what is here of it
  Ipv4Address source;
  std::uint16_t source_port = 0;
  Ipv4Address destination;
  HostTime stamp{};                                  // the kernel's
  std::optional<std::uint32_t> dropped_before_it{};  // SO_RXQ_OVFL, see live::DropCount
};

// Fixed memory for what one recvmmsg() call takes. One thread. RT: no allocation after
// construction.
class DatagramBatch {
 public:
  static constexpr std::size_t kCapacity = 64;
  // More than any packet of a lidar; of a longer datagram this much is kept.
  static constexpr std::size_t kMaxPayload = 2048;

  DatagramBatch() noexcept;
  DatagramBatch(const DatagramBatch&) = delete;
  DatagramBatch& operator=(const DatagramBatch&) = delete;

  // Takes what is there without waiting, at most kCapacity datagrams. Returns 0 or errno (EAGAIN:
  // none).
  [[nodiscard]] int receive(int socket) noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  // Valid until the next receive(). Precondition: index < size().
  [[nodiscard]] Datagram operator[](std::size_t index) const noexcept;

 private:
  static constexpr std::size_t kControlSize = live::kAncillarySize + CMSG_SPACE(sizeof(in_pktinfo));
  struct alignas(cmsghdr) Control {
    std::array<std::byte, kControlSize> bytes;
  };

  std::size_t size_ = 0;
  std::array<mmsghdr, kCapacity> messages_{};
  std::array<iovec, kCapacity> vectors_{};
  std::array<sockaddr_in, kCapacity> senders_{};
  std::array<Control, kCapacity> controls_{};
  std::array<std::array<std::byte, kMaxPayload>, kCapacity> payloads_;
};

}  // namespace convexcut::udp
