// SPDX-License-Identifier: Apache-2.0
//
// What other threads read of live sources while receive threads run: for ThreadSanitizer. Does not
// prove how fast a state is seen.
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/sources/live_sources.hpp"
#include "drivers/live/host_clock.hpp"
#include "replay/emulator/emulated_imu.hpp"
#include "tests/drivers/velodyne/packets.hpp"
#include "tests/drivers/xsens/frames.hpp"
#include "tests/support/udp_sender.hpp"

namespace convexcut::daemon {
namespace {

template <class Sample>
class CountingSink final : public Sink<Sample> {
 public:
  Sample* claim() noexcept override { return &slot_; }
  void commit() noexcept override { samples.fetch_add(1); }
  std::atomic<std::size_t> samples{0};

 private:
  Sample slot_;
};

TEST(LiveThreads, EverythingIsReadableWhileReceiveThreadsRun) {
  CountingSink<ReturnBatch> returns;
  CountingSink<ImuSample> samples;
  NullSink<EncoderSample> angles;
  replay::EmulatedImu imu;
  config::Config config;
  config.lidar.data_port = test::free_udp_port();
  config.lidar.position_port = test::free_udp_port();
  config.imu.device = imu.terminal().path();
  config.imu.configure = true;
  LiveSources live(config, returns, samples, angles);

  std::atomic<bool> stop{false};
  std::vector<std::thread> receivers;
  for (const LiveSources::Entry& entry : live.entries()) {
    receivers.emplace_back([&stop, &entry] {
      while (!stop.load()) entry.source.receive(std::chrono::milliseconds{5});
    });
  }
  const test::UdpSender sensor;
  const auto message = test::hex(xsens::test::kQuaternionMessage);
  std::uint32_t sent = 0;
  std::size_t read = 0;
  const auto give_up = live::Steady::now() + std::chrono::seconds{30};
  while ((returns.samples < 100 || samples.samples < 100) && live::Steady::now() < give_up) {
    imu.answer();
    imu.measure(message);
    velodyne::test::DataPacket packet;
    sensor.send("127.0.0.1", config.lidar.data_port, packet.timestamp(553 * ++sent).bytes());
    read += live.warnings().size() + live.kernel_drops() +
            live.lidar_driver().counters().data_packets.value() +
            live.imu_driver()->counters().samples.value() +
            live.imu()->configuration()->identity().size() + live.lidar().receive_buffer_bytes() +
            static_cast<std::size_t>(live.lidar_driver().model().has_value());
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  stop.store(true);
  for (std::thread& receiver : receivers) receiver.join();
  EXPECT_GE(returns.samples, 100U);
  EXPECT_GE(samples.samples, 100U);
  EXPECT_GT(read, 0U);
}

}  // namespace
}  // namespace convexcut::daemon
