// SPDX-License-Identifier: Apache-2.0
//
// Frames from a virtual CAN interface of a real kernel. Does not prove anything about a real
// controller: a virtual bus has no bit rate and no arbitration.
#include "drivers/socketcan/socketcan_source.hpp"

#include <gmock/gmock.h>

#include "drivers/can/can_imu_driver.hpp"
#include "drivers/live/host_clock.hpp"
#include "tests/drivers/socketcan/socketcan_rig.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"

namespace convexcut::socketcan {
namespace {

using can::test::make_frame;
using std::chrono::milliseconds;
using test::BusNode;
using test::error_frame;
using test::SocketCan;

struct TapKeeper final : live::RawTap {
  void on_record(const capture::Record& record) noexcept override {
    kinds.push_back(record.kind);
    can::CanFrame frame;
    if (can::decode_socketcan(record.payload, can::IdOrder::big_endian, record.stamp, frame) ==
        can::RecordStatus::ok) {
      frames.push_back(frame);
    }
  }
  std::vector<capture::RecordKind> kinds;
  std::vector<can::CanFrame> frames;
};

can::CanFrame extended(can::CanFrame frame) {
  frame.extended = true;
  return frame;
}

can::CanFrame fd_frame(std::uint32_t id, std::uint8_t length) {
  can::CanFrame frame;
  frame.id = id;
  frame.fd = true;
  frame.length = length;
  for (std::uint8_t i = 0; i < length; ++i) frame.data[i] = static_cast<std::byte>(i * 3 + 1);
  return frame;
}

TEST_F(SocketCan, ReceivesTheFramesOfItsIdentifiersAndNoOthers) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  const BusNode node(vcan);
  can::CanFrame request = make_frame(0x021, "");
  request.remote = true;
  node.send(make_frame(0x021, "7FFF 0001 8000 FFFF"));
  node.send(make_frame(0x022, "01"));
  node.send(extended(make_frame(0x021, "02")));
  node.send(request);
  node.send(extended(make_frame(0x19FF0032, "03 04")));
  node.send(make_frame(0x032, "05"));
  node.send(make_frame(0x034, ""));
  ASSERT_TRUE(run_until(source, [&] { return keeper.frames.size() >= 3; }));
  source.receive(milliseconds{50});

  ASSERT_EQ(keeper.frames.size(), 3U);
  EXPECT_EQ(keeper.frames[0].id, 0x021U);
  EXPECT_FALSE(keeper.frames[0].extended);
  EXPECT_THAT(keeper.frames[0].payload(),
              testing::ElementsAreArray(convexcut::test::hex("7FFF00018000FFFF")));
  EXPECT_EQ(keeper.frames[1].id, 0x19FF0032U);
  EXPECT_TRUE(keeper.frames[1].extended);
  EXPECT_EQ(keeper.frames[1].length, 2);
  EXPECT_EQ(keeper.frames[2].id, 0x034U);
  EXPECT_EQ(keeper.frames[2].length, 0);
  EXPECT_EQ(source.counters().frames.value(), 3U);
  EXPECT_EQ(source.counters().malformed.value(), 0U);
}

TEST_F(SocketCan, ReceivesFdFramesOfEveryLength) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  const BusNode node(vcan);
  constexpr std::array<std::uint8_t, 9> kLengths{0, 8, 12, 16, 20, 24, 32, 48, 64};
  for (const std::uint8_t length : kLengths) node.send(fd_frame(0x034, length));
  ASSERT_TRUE(run_until(source, [&] { return keeper.frames.size() >= kLengths.size(); }));
  for (std::size_t i = 0; i < kLengths.size(); ++i) {
    EXPECT_TRUE(keeper.frames[i].fd);
    EXPECT_EQ(keeper.frames[i].length, kLengths[i]);
    EXPECT_EQ(keeper.frames[i].data, fd_frame(0x034, kLengths[i]).data);
  }
}

TEST_F(SocketCan, StampsAreTheKernelsAndNotThoseOfTheReading) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  const BusNode node(vcan);
  const HostTime before = live::host_now();
  for (unsigned i = 0; i < 5; ++i) node.send(make_frame(0x021, "00"));
  const HostTime after = live::host_now();
  // Read later than sent: a stamp of the reading would lie behind `after`.
  ASSERT_TRUE(run_until(source, [&] { return keeper.frames.size() >= 5; }));
  HostTime last = before;
  for (const can::CanFrame& frame : keeper.frames) {
    EXPECT_GE(frame.stamp, last);
    EXPECT_LE(frame.stamp, after);
    last = frame.stamp;
  }
}

TEST_F(SocketCan, CountsWhatTheKernelDropsWhenNobodyReads) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  const BusNode node(vcan);
  constexpr std::size_t kFlood = 20'000;
  for (std::size_t i = 0; i < kFlood; ++i) node.send(make_frame(0x021, "00"));
  ASSERT_TRUE(run_until(source, [&] { return !keeper.frames.empty(); }));
  // The count comes with the first frame that is received after the drops.
  const auto drain = [&] {
    for (std::size_t had = 0; had != keeper.frames.size();) {
      had = keeper.frames.size();
      source.receive(milliseconds{50});
    }
  };
  drain();
  node.send(make_frame(0x034, "00"));
  ASSERT_TRUE(run_until(source, [&] { return keeper.frames.back().id == 0x034U; }));
  EXPECT_GT(source.counters().dropped.value(), 0U);
  EXPECT_EQ(source.counters().dropped.value() + keeper.frames.size() + vcan.lost_before_sockets(),
            kFlood + 1);
}

TEST_F(SocketCan, FlushesTheReceiverOnceAfterAPause) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  BusNode(vcan).send(make_frame(0x021, "00"));
  ASSERT_TRUE(run_until(source, [&] { return !keeper.flushed_after.empty(); }));
  EXPECT_EQ(keeper.flushed_after.front(), 1U);
  source.receive(milliseconds{50});
  source.receive(milliseconds{50});
  EXPECT_EQ(keeper.flushed_after.size(), 1U);
}

TEST_F(SocketCan, TapHearsTheRecordsThatACaptureWouldHold) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  TapKeeper tap;
  SocketCanSource source(options_for(vcan), keeper, &tap);
  ASSERT_TRUE(open(source));
  const BusNode node(vcan);
  node.send(extended(make_frame(0x19FF0032, "01 02")));
  node.send(fd_frame(0x034, 32));
  node.send(fd_frame(0x034, 8));
  node.send(error_frame(can::kBusOff));
  ASSERT_TRUE(run_until(source, [&] { return keeper.frames.size() >= 4; }));
  ASSERT_EQ(tap.frames.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(tap.kinds[i], capture::RecordKind::can);
    EXPECT_EQ(tap.frames[i].id, keeper.frames[i].id);
    EXPECT_EQ(tap.frames[i].extended, keeper.frames[i].extended);
    EXPECT_EQ(tap.frames[i].error, keeper.frames[i].error);
    EXPECT_EQ(tap.frames[i].fd, keeper.frames[i].fd);
    EXPECT_EQ(tap.frames[i].data, keeper.frames[i].data);
    EXPECT_EQ(tap.frames[i].stamp, keeper.frames[i].stamp);
  }
}

TEST_F(SocketCan, ImuFramesBecomeTheSamplesOfTheSameFramesFromALog) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  convexcut::test::RecordingSink live_sink;
  can::CanImuDriver driver({}, live_sink);
  SocketCanSource source({.interface = vcan.name(), .ids = can::received_ids({})}, driver);
  ASSERT_TRUE(open(source));
  const BusNode node(vcan);

  struct Relay final : can::FrameReceiver {  // keeps the stamps that the kernel gave
    void on_frame(const can::CanFrame& frame) noexcept override { frames.push_back(frame); }
    void flush() noexcept override {}
    std::vector<can::CanFrame> frames;
  } relay;
  SocketCanSource witness({.interface = vcan.name(), .ids = can::received_ids({})}, relay);
  ASSERT_TRUE(open(witness));

  constexpr unsigned kGroups = 20;
  for (unsigned n = 0; n < kGroups; ++n) {
    can::CanFrame time = make_frame(0x005, "00000000");
    time.data[2] = static_cast<std::byte>((n * 10'000) >> 8U);
    time.data[3] = static_cast<std::byte>(n * 10'000);
    time.data[1] = static_cast<std::byte>((n * 10'000) >> 16U);
    can::CanFrame quaternion = make_frame(0x021, "7FFF 0000 0000 0000");
    quaternion.data[3] = static_cast<std::byte>(n);
    node.send(time);
    node.send(make_frame(0x011, "00400003"));
    node.send(make_frame(0x061, "0102 0304 0506"));  // high-rate data, filtered out
    node.send(quaternion);
    node.send(make_frame(0x032, "0064 FF9C 0000"));
    node.send(make_frame(0x034, "0000 0000 09CF"));
  }
  ASSERT_TRUE(run_until(source, [&] { return live_sink.samples.size() == kGroups; }));
  ASSERT_TRUE(run_until(witness, [&] { return relay.frames.size() == kGroups * 5; }));

  convexcut::test::RecordingSink log_sink;
  can::CanImuDriver log_driver({}, log_sink);
  for (const can::CanFrame& frame : relay.frames) log_driver.on_frame(frame);
  log_driver.flush();
  ASSERT_EQ(log_sink.samples.size(), kGroups);
  for (std::size_t i = 0; i < kGroups; ++i) {
    const ImuSample& live = live_sink.samples[i];
    const ImuSample& log = log_sink.samples[i];
    EXPECT_EQ(live.arrival, log.arrival);
    EXPECT_EQ(live.device_time, log.device_time);
    EXPECT_EQ(live.q_level_from_imu.coeffs(), log.q_level_from_imu.coeffs());
    EXPECT_EQ(live.angular_velocity_rad_s, log.angular_velocity_rad_s);
    EXPECT_EQ(live.acceleration_m_s2, log.acceleration_m_s2);
    EXPECT_EQ(live.status, 0x00400003U);
  }
  EXPECT_EQ(driver.counters().foreign_frames.value(), 0U) << "the kernel's filter let others in";
}

}  // namespace
}  // namespace convexcut::socketcan
