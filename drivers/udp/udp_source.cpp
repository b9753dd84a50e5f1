// SPDX-License-Identifier: Apache-2.0
#include "drivers/udp/udp_source.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <utility>

#include <poll.h>

#include "drivers/live/host_clock.hpp"

namespace convexcut::udp {
namespace {

// A port that never runs dry must not keep the other one waiting.
constexpr int kMaxBatchesInARow = 16;

}  // namespace

UdpSource::UdpSource(UdpSourceOptions options, velodyne::LidarDriver& driver, live::RawTap* tap)
    : options_(std::move(options)),
      ports_{options_.data_port, options_.position_port},
      driver_(driver),
      tap_(tap) {}

void UdpSource::receive(Duration wait) noexcept {
  const auto now = live::Steady::now();
  if (pause_.take(now)) {
    if (!is_open()) open();
    if (is_open()) check_network();
  }
  if (is_open()) {
    wait_for_input(wait);
  } else {
    const std::timespec pause = live::to_timespec(pause_.left(now, wait));
    ::clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
  }
}

void UdpSource::open() noexcept {
  for (std::size_t port = 0; port < kPorts; ++port) {
    const int error = sockets_[port].open(options_.socket, ports_[port]);
    if (error != 0) return fail(error);
  }
  interface_index_ = 0;
  if (!options_.socket.interface.empty()) {
    interface_index_ = sockets_[0].interface_state(options_.socket.interface).index;
  }
  // The position port's few datagrams fit any buffer: the data port's is what matters.
  granted_buffer_.store(sockets_[0].receive_buffer_bytes(), std::memory_order_relaxed);
  counters_.opened.add();
}

void UdpSource::fail(int error) noexcept {
  for (UdpSocket& socket : sockets_) socket.close();
  status_.set(live::LinkState::closed, error);
  pause_.restart(live::Steady::now());
}

void UdpSource::check_network() noexcept {
  InterfaceState interface { 0, true };
  if (!options_.socket.interface.empty()) {
    interface = sockets_[0].interface_state(options_.socket.interface);
    // An adapter that was plugged in again has the name of old and another index: the sockets are
    // bound to one that is gone.
    if (interface.index == 0 || interface.index != interface_index_) return fail(ENODEV);
  }
  for (UdpSocket& socket : sockets_) counters_.kernel_drops.add(socket.new_drops());
  const int join_error = join_group(interface.index);
  if (join_error == ENOBUFS) return fail(join_error);  // memberships of interfaces that are gone
  if (join_error != 0) {
    status_.set(live::LinkState::closed, join_error);
  } else if (!interface.up) {
    status_.set(live::LinkState::closed, ENETDOWN);
  } else {
    status_.set_open();
  }
}

int UdpSource::join_group(int interface_index) noexcept {
  if (!options_.socket.multicast_group) return 0;
  int error = 0;
  for (UdpSocket& socket : sockets_) {
    const int failed = socket.join(*options_.socket.multicast_group, interface_index);
    if (failed != 0) error = failed;
  }
  return error;
}

void UdpSource::wait_for_input(Duration wait) noexcept {
  std::array<pollfd, kPorts> polls{};
  for (std::size_t port = 0; port < kPorts; ++port) {
    polls[port] = {sockets_[port].fd(), POLLIN, 0};
  }
  const Duration gathering = came_ ? std::min(options_.gather, wait) : Duration{0};
  if (gathering > Duration{0}) {
    const std::timespec pause = live::to_timespec(gathering);
    ::clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
  }
  const std::timespec timeout = live::to_timespec(std::max(wait, Duration{0}));
  const int ready = ::ppoll(polls.data(), polls.size(), &timeout, nullptr);
  came_ = ready > 0;
  if (!came_) return;  // nothing came, or a signal did
  for (std::size_t port = 0; port < kPorts && is_open(); ++port) {
    if (polls[port].revents != 0) drain(port);
  }
}

void UdpSource::drain(std::size_t port) noexcept {
  for (int i = 0; i < kMaxBatchesInARow; ++i) {
    const int error = batch_.receive(sockets_[port].fd());
    if (error == EAGAIN || error == EWOULDBLOCK || error == EINTR) return;
    if (error != 0) {
      counters_.receive_errors.add();
      return fail(error);
    }
    if (batch_.size() == 0) return;
    counters_.batches.add();
    counters_.datagrams.add(batch_.size());
    for (std::size_t n = 0; n < batch_.size(); ++n) deliver(batch_[n], port);
    if (batch_.size() < DatagramBatch::kCapacity) return;
  }
}

void UdpSource::deliver(const Datagram& datagram, std::size_t port) noexcept {
  if (datagram.dropped_before_it) {
    counters_.kernel_drops.add(sockets_[port].new_drops(*datagram.dropped_before_it));
  }
  if (datagram.truncated) counters_.truncated.add();
  if (tap_ != nullptr) {
    tap_->on_record({.stamp = datagram.stamp,
                     .kind = capture::RecordKind::datagram,
                     .source_port = datagram.source_port,
                     .destination_port = ports_[port],
                     .source = datagram.source,
                     .destination = datagram.destination,
                     .payload = datagram.payload});
  }
  driver_.on_datagram(datagram.payload, ports_[port], datagram.stamp, datagram.source);
}

}  // namespace convexcut::udp
