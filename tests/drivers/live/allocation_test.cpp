// SPDX-License-Identifier: Apache-2.0
//
// What runs on receive threads allocates nothing, whatever happens to the link. Does not see memory
// that is mapped by other means than operator new.
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "drivers/live/host_clock.hpp"
#include "drivers/serial/serial_source.hpp"
#include "drivers/udp/udp_source.hpp"
#include "replay/emulator/emulated_imu.hpp"
#include "tests/drivers/velodyne/packets.hpp"
#include "tests/drivers/xsens/frames.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/udp_sender.hpp"

namespace convexcut::live {
namespace {

template <class Sample>
class CountingSink final : public Sink<Sample> {
 public:
  Sample* claim() noexcept override { return &slot_; }
  void commit() noexcept override { ++samples; }
  std::size_t samples = 0;

 private:
  Sample slot_;
};

// Calls receive() until it is so, and adds what that allocated; `meanwhile` is not counted.
template <class Done>
bool receive_until(
    LiveSource& source, std::uint64_t& allocated, const Done& done,
    const std::function<void()>& meanwhile = [] {}) {
  const auto give_up = Steady::now() + std::chrono::seconds{20};
  while (!done()) {
    if (Steady::now() > give_up) return false;
    meanwhile();
    const std::uint64_t before = test::allocations();
    source.receive(std::chrono::milliseconds{5});
    allocated += test::allocations() - before;
  }
  return true;
}

TEST(ReceiveThread, UdpSourceAllocatesNothing) {
  const std::uint16_t port = test::free_udp_port();
  const std::uint16_t position_port = test::free_udp_port();
  CountingSink<ReturnBatch> sink;
  velodyne::LidarDriver driver({.data_port = port, .position_port = position_port}, sink);
  udp::UdpSource source({.data_port = port, .position_port = position_port}, driver);
  std::uint64_t allocated = 0;
  ASSERT_TRUE(receive_until(source, allocated, [&] { return source.link() == LinkState::open; }));
  const test::UdpSender sender;
  std::uint32_t sent = 0;
  ASSERT_TRUE(receive_until(
      source, allocated, [&] { return sink.samples > 200; },
      [&] {
        velodyne::test::DataPacket packet;
        sender.send("127.0.0.1", port, packet.timestamp(553 * ++sent).bytes());
        sender.send("127.0.0.1", port, velodyne::test::PositionDatagram().bytes());
        sender.send("127.0.0.1", position_port, velodyne::test::PositionDatagram().bytes());
      }));
  EXPECT_EQ(allocated, 0U);
}

TEST(ReceiveThread, UdpSourceWithoutItsInterfaceAllocatesNothing) {
  CountingSink<ReturnBatch> sink;
  velodyne::LidarDriver driver({}, sink);
  udp::UdpSource source({.socket = {.interface = "no-such-if0"}}, driver);
  std::uint64_t allocated = 0;
  ASSERT_TRUE(receive_until(source, allocated, [&] { return source.last_error() != 0; }));
  EXPECT_EQ(allocated, 0U);
}

TEST(ReceiveThread, SerialSourceThatConfiguresAndIsUnpluggedAllocatesNothing) {
  const test::TemporaryDirectory directory;
  std::optional<replay::EmulatedImu> imu(std::in_place, directory.path() / "imu");
  CountingSink<ImuSample> sink;
  xsens::ImuDriver driver({}, sink);
  serial::SerialSource source(
      {.device = directory.path() / "imu",
       .configuration = xsens::MtConfigurationOptions{.set_baud = 921600, .scan_baud = true}},
      driver);
  std::uint64_t allocated = 0;
  const auto message = test::hex(xsens::test::kImuSetMessage);
  const auto measure = [&] {
    imu->answer();
    imu->measure(message);
  };
  for (std::size_t times = 1; times <= 2; ++times) {
    ASSERT_TRUE(receive_until(
        source, allocated, [&] { return sink.samples >= 50 * times; }, measure));
    EXPECT_EQ(source.configuration()->state(), xsens::MtState::measuring);
    imu->unplug();
    ASSERT_TRUE(
        receive_until(source, allocated, [&] { return source.link() == LinkState::closed; }));
    imu->plug_in();
  }
  EXPECT_EQ(allocated, 0U);
}

}  // namespace
}  // namespace convexcut::live
