// SPDX-License-Identifier: Apache-2.0
//
// A lidar's two UDP ports, live → LidarDriver.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "core/counter.hpp"
#include "drivers/live/link_status.hpp"
#include "drivers/live/live_source.hpp"
#include "drivers/live/raw_tap.hpp"
#include "drivers/live/retry_pause.hpp"
#include "drivers/udp/datagram_batch.hpp"
#include "drivers/udp/udp_socket.hpp"
#include "drivers/velodyne/lidar_driver.hpp"

namespace convexcut::udp {

struct UdpSourceOptions {
  std::uint16_t data_port = velodyne::wire_layout::kDataPort;
  std::uint16_t position_port = velodyne::wire_layout::kPositionPort;
  UdpSocketOptions socket{};
  // While datagrams come, this long is waited before they are taken together: fewer wake-ups for as
  // much more delay. Stamps are the kernel's and do not change.
  Duration gather{};
};

struct UdpCounters {
  Counter datagrams;     // received, of any content
  Counter batches;       // calls that received some
  Counter kernel_drops;  // dropped by the kernel before we came: the receive buffer was full
  Counter truncated;     // of the received: longer than DatagramBatch::kMaxPayload
  Counter receive_errors;
  Counter opened;  // times that the sockets were opened: 1, and 1 for each recovery
};

// Hands every datagram to the tap and to the driver, stamped by the kernel. What a datagram is
// worth is the driver's business: a truncated one has a length that it refuses.
//
// The link is open while both sockets are bound and, where they are configured, the interface is up
// and the group is joined. Without an interface nothing of the network is needed: it may come up
// later, and sensors may come and go. After an error the sockets are opened anew, a few times a
// second.
//
// Thread: receive() on one; the rest from any. RT: see LiveSource.
class UdpSource final : public live::LiveSource {
 public:
  // `driver` and `tap` (which may be null) outlive the source.
  UdpSource(UdpSourceOptions options, velodyne::LidarDriver& driver, live::RawTap* tap = nullptr);

  void receive(Duration wait) noexcept override;
  [[nodiscard]] live::LinkState link() const noexcept override { return status_.state(); }
  [[nodiscard]] int last_error() const noexcept override { return status_.last_error(); }

  [[nodiscard]] const UdpCounters& counters() const noexcept { return counters_; }
  // What the kernel granted of options.socket.receive_buffer_bytes; 0 before the first opening.
  [[nodiscard]] std::size_t receive_buffer_bytes() const noexcept {
    return granted_buffer_.load(std::memory_order_relaxed);  // a value on its own: orders nothing
  }

 private:
  static constexpr std::size_t kPorts = 2;

  [[nodiscard]] bool is_open() const noexcept { return sockets_[0].fd() >= 0; }
  void open() noexcept;
  void fail(int error) noexcept;
  void check_network() noexcept;
  [[nodiscard]] int join_group(int interface_index) noexcept;
  void wait_for_input(Duration wait) noexcept;
  void drain(std::size_t port) noexcept;
  void deliver(const Datagram& datagram, std::size_t port) noexcept;

  UdpSourceOptions options_;
  std::array<std::uint16_t, kPorts> ports_;
  velodyne::LidarDriver& driver_;
  live::RawTap* tap_;
  live::LinkStatus status_;
  live::RetryPause pause_;  // between openings; while open, between looks at the network
  UdpCounters counters_;
  std::atomic<std::size_t> granted_buffer_{0};  // pairs with receive_buffer_bytes()
  int interface_index_ = 0;                     // that the sockets are bound to
  bool came_ = false;                           // something, in the last wait
  std::array<UdpSocket, kPorts> sockets_;
  DatagramBatch batch_;
};

}  // namespace convexcut::udp
