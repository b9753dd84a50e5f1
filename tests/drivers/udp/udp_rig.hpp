// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "drivers/udp/udp_source.hpp"
#include "tests/drivers/velodyne/collecting_sink.hpp"
#include "tests/drivers/velodyne/packets.hpp"
#include "tests/support/udp_sender.hpp"

namespace convexcut::udp::test {

// Keeps what a tap hears.
class CollectingTap final : public live::RawTap {
 public:
  struct Heard {
    capture::Record record;
    std::vector<std::byte> payload;
  };
  void on_record(const capture::Record& record) noexcept override {
    heard.push_back({record, {record.payload.begin(), record.payload.end()}});
  }
  std::vector<Heard> heard;
};

// A source on two free ports of this host.
class UdpRig {
 public:
  explicit UdpRig(const UdpSocketOptions& socket = {},
                  std::optional<Ipv4Address> from = std::nullopt, Duration gather = {})
      : driver({.model = velodyne::ModelId::hdl32e,
                .data_port = data_port,
                .position_port = position_port,
                .from = from},
               sink),
        source({data_port, position_port, socket, gather}, driver, &tap) {}

  // Receives until it is so; false after a time that no test takes unless it fails.
  bool receive_until(const std::function<bool()>& done) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds{20};
    while (!done()) {
      if (std::chrono::steady_clock::now() > give_up) return false;
      source.receive(std::chrono::milliseconds{10});
    }
    return true;
  }
  bool receive_datagrams(std::uint64_t count) {
    return receive_until([&] { return source.counters().datagrams.value() >= count; });
  }
  bool link_becomes(live::LinkState state) {
    return receive_until([&] { return source.link() == state; });
  }

  const std::uint16_t data_port = convexcut::test::free_udp_port();
  const std::uint16_t position_port = convexcut::test::free_udp_port();
  velodyne::test::CollectingSink sink;
  CollectingTap tap;
  velodyne::LidarDriver driver;
  UdpSource source;
};

}  // namespace convexcut::udp::test
