// SPDX-License-Identifier: Apache-2.0
#include "drivers/udp/udp_socket.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstring>

#include <linux/sock_diag.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "drivers/live/ancillary.hpp"

namespace convexcut::udp {
namespace {

template <class Value>
bool set_option(int fd, int level, int name, const Value& value) noexcept {
  return ::setsockopt(fd, level, name, &value, sizeof(value)) == 0;
}

sockaddr_in address_of(std::optional<Ipv4Address> address, std::uint16_t port) noexcept {
  sockaddr_in socket_address{};
  socket_address.sin_family = AF_INET;
  socket_address.sin_port = htons(port);
  socket_address.sin_addr.s_addr = address ? htonl(address->value) : htonl(INADDR_ANY);
  return socket_address;
}

ifreq request_for(const std::string& interface) noexcept {
  ifreq request{};
  const std::size_t length = std::min(interface.size(), sizeof(request.ifr_name) - 1);
  std::memcpy(request.ifr_name, interface.data(), length);
  return request;
}

}  // namespace

int UdpSocket::open(const UdpSocketOptions& options, std::uint16_t port) noexcept {
  close();
  fd_ = live::FileDescriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd_) return errno;
  const int error = set_up(options, port);
  if (error != 0) close();
  return error;
}

void UdpSocket::close() noexcept {
  fd_.reset();
  drops_ = {};
}

int UdpSocket::set_up(const UdpSocketOptions& options, std::uint16_t port) noexcept {
  const int fd = fd_.get();
  constexpr int kOn = 1;
  constexpr int kOff = 0;
  const bool set = set_option(fd, SOL_SOCKET, SO_REUSEADDR, kOn) &&
                   set_option(fd, SOL_SOCKET, SO_BROADCAST, kOn) && live::request_ancillary(fd) &&
                   set_option(fd, IPPROTO_IP, IP_PKTINFO, kOn) &&
                   set_option(fd, IPPROTO_IP, IP_FREEBIND, kOn) &&
                   // Groups that other programs of this host have joined are none of ours.
                   set_option(fd, IPPROTO_IP, IP_MULTICAST_ALL, kOff);
  if (!set) return errno;
  set_receive_buffer(options.receive_buffer_bytes);
  if (!options.interface.empty()) {
    const ifreq request = request_for(options.interface);
    if (!set_option(fd, SOL_SOCKET, SO_BINDTODEVICE, request.ifr_name)) return errno;
  }
  const sockaddr_in local = address_of(options.local_address, port);
  // The socket API's own way of passing addresses.
  const auto* generic = reinterpret_cast<const sockaddr*>(&local);
  return ::bind(fd, generic, sizeof(local)) == 0 ? 0 : errno;
}

void UdpSocket::set_receive_buffer(std::size_t bytes) noexcept {
  const int wanted = static_cast<int>(std::min<std::size_t>(bytes, INT_MAX / 2));
  // The first is for the privileged; the second is cut to net.core.rmem_max without an error.
  if (!set_option(fd_.get(), SOL_SOCKET, SO_RCVBUFFORCE, wanted)) {
    set_option(fd_.get(), SOL_SOCKET, SO_RCVBUF, wanted);
  }
  int doubled = 0;  // the kernel sets twice of what it is asked for, and says so
  socklen_t size = sizeof(doubled);
  ::getsockopt(fd_.get(), SOL_SOCKET, SO_RCVBUF, &doubled, &size);
  receive_buffer_bytes_ = static_cast<std::size_t>(std::max(doubled, 0)) / 2;
}

int UdpSocket::join(Ipv4Address group, int interface_index) noexcept {
  ip_mreqn request{};
  request.imr_multiaddr.s_addr = htonl(group.value);
  request.imr_ifindex = interface_index;
  if (set_option(fd_.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, request)) return 0;
  return errno == EADDRINUSE ? 0 : errno;
}

InterfaceState UdpSocket::interface_state(const std::string& interface) const noexcept {
  InterfaceState state;
  ifreq request = request_for(interface);
  if (::ioctl(fd_.get(), SIOCGIFINDEX, &request) != 0) return state;
  state.index = request.ifr_ifindex;
  if (::ioctl(fd_.get(), SIOCGIFFLAGS, &request) != 0) return state;
  constexpr int kCarrier = IFF_UP | IFF_RUNNING;
  state.up = (request.ifr_flags & kCarrier) == kCarrier;
  return state;
}

std::uint32_t UdpSocket::new_drops() noexcept {
  std::array<std::uint32_t, SK_MEMINFO_VARS> info{};
  socklen_t size = sizeof(info);
  if (::getsockopt(fd_.get(), SOL_SOCKET, SO_MEMINFO, info.data(), &size) != 0) return 0;
  return drops_.advance(info[SK_MEMINFO_DROPS]);
}

}  // namespace convexcut::udp
