// SPDX-License-Identifier: Apache-2.0
#include "tests/support/udp_sender.hpp"

#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace convexcut::test {
namespace {

sockaddr_in socket_address(const std::string& address, std::uint16_t port) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  EXPECT_EQ(::inet_pton(AF_INET, address.c_str(), &to.sin_addr), 1) << address;
  return to;
}

const sockaddr* generic(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

}  // namespace

UdpSender::UdpSender() : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  EXPECT_GE(fd_, 0) << std::strerror(errno);
  const int on = 1;
  EXPECT_EQ(::setsockopt(fd_, SOL_SOCKET, SO_BROADCAST, &on, sizeof(on)), 0);
}

UdpSender::~UdpSender() { ::close(fd_); }

void UdpSender::from(const std::string& local_address) {
  const sockaddr_in local = socket_address(local_address, 0);
  EXPECT_EQ(::bind(fd_, generic(local), sizeof(local)), 0) << std::strerror(errno);
}

void UdpSender::through(const std::string& interface) {
  ip_mreqn request{};
  request.imr_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  EXPECT_EQ(::setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_IF, &request, sizeof(request)), 0)
      << std::strerror(errno);
  EXPECT_EQ(::setsockopt(fd_, SOL_SOCKET, SO_BINDTODEVICE, interface.c_str(),
                         static_cast<socklen_t>(interface.size())),
            0)
      << std::strerror(errno);
}

int UdpSender::try_send(const std::string& address, std::uint16_t port,
                        std::span<const std::byte> payload) const {
  const sockaddr_in to = socket_address(address, port);
  const ssize_t sent = ::sendto(fd_, payload.data(), payload.size(), 0, generic(to), sizeof(to));
  return sent == static_cast<ssize_t>(payload.size()) ? 0 : errno;
}

void UdpSender::send(const std::string& address, std::uint16_t port,
                     std::span<const std::byte> payload) const {
  const int error = try_send(address, port, payload);
  EXPECT_EQ(error, 0) << address << ": " << std::strerror(error);
}

std::uint16_t free_udp_port() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  EXPECT_EQ(::bind(fd, generic(address), sizeof(address)), 0);
  socklen_t size = sizeof(address);
  EXPECT_EQ(::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size), 0);
  ::close(fd);
  return ntohs(address.sin_port);
}

}  // namespace convexcut::test
