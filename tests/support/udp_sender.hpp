// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace convexcut::test {

// Sends datagrams from a port of its own. Failures fail the test.
class UdpSender {
 public:
  UdpSender();
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  void from(const std::string& local_address);
  void through(const std::string& interface);
  // 0 or errno, for the callers to judge.
  [[nodiscard]] int try_send(const std::string& address, std::uint16_t port,
                             std::span<const std::byte> payload) const;
  void send(const std::string& address, std::uint16_t port,
            std::span<const std::byte> payload) const;

 private:
  int fd_;
};

// A port that nobody used a moment ago.
[[nodiscard]] std::uint16_t free_udp_port();

}  // namespace convexcut::test
