// SPDX-License-Identifier: Apache-2.0
//
// Frames of an encoder, alone and among those of an IMU. Does not prove that a given drive maps its
// position as the preset has it: the mapping is the drive's configuration.
#include "drivers/can/encoder_driver.hpp"

#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/can/bus_devices.hpp"
#include "tests/drivers/can/frames.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"

namespace convexcut::can {
namespace {

using convexcut::test::RecordingSink;
using test::make_frame;

constexpr HostTime kReceived = from_ns<HostTime>(1'700'000'000'000'000'000);

struct AngleSink final : Sink<EncoderSample> {
  EncoderSample* claim() noexcept override { return samples.size() < capacity ? &slot : nullptr; }
  void commit() noexcept override { samples.push_back(slot); }
  std::vector<EncoderSample> samples;
  EncoderSample slot;
  std::size_t capacity = 100;
};

EncoderOptions drive() {
  EncoderOptions options;
  options.id = {0x181, false};
  options.signal = cia402_position();
  options.signal.scale = 0.001;
  options.signal.offset = 10.0;
  return options;
}

TEST(EncoderDriver, AFrameIsAnAngleAtTheTimeItBeganOnTheBus) {
  AngleSink sink;
  EncoderDriver driver(drive(), sink);
  driver.on_frame(make_frame(0x181, "37 06 90 5F 01 00", kReceived));  // 90 000 counts
  ASSERT_EQ(sink.samples.size(), 1U);
  EXPECT_DOUBLE_EQ(to_degrees(sink.samples[0].angle).value, 100.0);
  // 44 bits around 6 bytes at 250 kbit/s.
  EXPECT_EQ(sink.samples[0].arrival, kReceived - std::chrono::microseconds{368});
  EXPECT_EQ(driver.counters().samples.value(), 1U);
}

TEST(EncoderDriver, WhatHoldsNoAngleIsCountedByReason) {
  AngleSink sink;
  sink.capacity = 1;
  EncoderOptions options = drive();
  options.signal = cia402_position_sdo();
  EncoderDriver driver(options, sink);
  CanFrame remote = make_frame(0x181, "");
  remote.remote = true;
  CanFrame error = make_frame(0x181, "43 64 60 00 00 00 00 00");
  error.error = true;
  CanFrame extended = make_frame(0x181, "43 64 60 00 00 00 00 00");
  extended.extended = true;
  driver.on_frame(remote);
  driver.on_frame(error);
  driver.on_frame(extended);
  driver.on_frame(make_frame(0x182, "43 64 60 00 00 00 00 00"));
  driver.on_frame(make_frame(0x181, "43 64 60 00 00 00 00"));
  driver.on_frame(make_frame(0x181, "4B 41 60 00 00 00 00 00"));
  driver.on_frame(make_frame(0x181, "43 64 60 00 00 00 00 00"));
  driver.on_frame(make_frame(0x181, "43 64 60 00 00 00 00 00"));
  const EncoderCounters& counters = driver.counters();
  EXPECT_EQ(counters.frames.value(), 5U);
  EXPECT_EQ(counters.remote_frames.value(), 1U);
  EXPECT_EQ(counters.short_frames.value(), 1U);
  EXPECT_EQ(counters.other_signals.value(), 1U);
  EXPECT_EQ(counters.samples.value(), 1U);
  EXPECT_EQ(counters.sink_full.value(), 1U);
}

TEST(EncoderDriver, FdFramesHoldSignalsToo) {
  AngleSink sink;
  EncoderOptions options = drive();
  options.signal = {.order = ByteOrder::motorola, .start_bit = 47 * 8 + 7, .length = 8};
  EncoderDriver driver(options, sink);
  CanFrame frame;
  frame.id = 0x181;
  frame.fd = true;
  frame.length = 48;
  frame.data[47] = std::byte{0xFF};
  driver.on_frame(frame);
  ASSERT_EQ(sink.samples.size(), 1U);
  EXPECT_DOUBLE_EQ(to_degrees(sink.samples[0].angle).value, -1.0);
}

TEST(EncoderDriver, SignalThatNoFrameCanHoldIsRefused) {
  AngleSink sink;
  EncoderOptions options = drive();
  options.signal.length = 65;
  EXPECT_THROW(EncoderDriver(options, sink), std::invalid_argument);
}

TEST(BusDevices, EachDeviceGetsItsOwnFrames) {
  AngleSink angles;
  RecordingSink samples;
  BusDevices devices({.imu = {}, .encoder = drive()}, samples, angles);
  for (unsigned group = 0; group < 4; ++group) {
    const HostTime at = kReceived + group * std::chrono::milliseconds{10};
    CanFrame time = make_frame(0x005, "00000000", at);
    time.data[2] = static_cast<std::byte>(group * 10'000 >> 8U);
    time.data[3] = static_cast<std::byte>(group * 10'000);
    devices.on_frame(time);
    devices.on_frame(make_frame(0x021, "7FFF 0000 0000 0000", at));
    devices.on_frame(make_frame(0x181, "37 06 00 00 00 00", at));
    devices.on_frame(make_frame(0x032, "0000 0000 0000", at));
  }
  CanFrame bus_off = make_frame(0x040, "0000000000000000");
  bus_off.error = true;
  devices.on_frame(bus_off);
  devices.flush();
  EXPECT_EQ(samples.samples.size(), 4U);
  EXPECT_EQ(angles.samples.size(), 4U);
  EXPECT_EQ(devices.imu().counters().foreign_frames.value(), 0U);
  EXPECT_EQ(devices.imu().counters().bus_off.value(), 1U);
}

TEST(BusDevices, ReceiveTheIdentifiersOfAllDevices) {
  BusOptions options;
  EXPECT_EQ(received_ids(options).size(), 9U);
  options.encoder = drive();
  options.encoder->id = {0x18181, true};
  EXPECT_EQ(received_ids(options).size(), 10U);
  EXPECT_THAT(received_ids(options), testing::Contains(CanId{0x18181, true}));
}

TEST(BusDevices, WithoutAnEncoderItsFramesAreForeign) {
  AngleSink angles;
  RecordingSink samples;
  BusDevices devices({}, samples, angles);
  devices.on_frame(make_frame(0x181, "37 06 00 00 00 00"));
  EXPECT_EQ(devices.encoder(), nullptr);
  EXPECT_TRUE(angles.samples.empty());
  EXPECT_EQ(devices.imu().counters().foreign_frames.value(), 1U);
}

}  // namespace
}  // namespace convexcut::can
