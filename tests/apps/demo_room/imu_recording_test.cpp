// SPDX-License-Identifier: Apache-2.0
//
// imu.pcap and can.log, decoded independently and held against the rig's motion and each other. Not
// proved: the timing of a real device or bus.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "apps/demo_room/recording.hpp"
#include "tests/apps/demo_room/mini_decoder.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::sim {
namespace {

using namespace std::chrono_literals;
using test::MiniCanFrame;
using test::PcapFile;
using test::TemporaryDirectory;

constexpr std::int64_t kStartNs = 1'772'359'198'000'000'000;  // 2026-03-01 09:59:58 UTC

// Both devices on the true clock, so that samples of the same number are of the same time.
RecordingOptions exact_imus() {
  RecordingOptions options;
  options.length = 2s;
  options.imu_margin = 0s;
  options.serial_imu.clock = {};
  options.serial_imu.noise = {0.0, 0.0};
  options.can_imu.clock = {};
  options.can_imu.noise = {0.0, 0.0};
  return options;
}

PcapFile serial(const RecordingOptions& options) {
  const TemporaryDirectory folder;
  write_serial_imu(options, folder.path() / "imu.pcap");
  return test::read_pcap(folder.path() / "imu.pcap");
}

std::vector<MiniCanFrame> can(const RecordingOptions& options) {
  const TemporaryDirectory folder;
  write_can_imu(options, folder.path() / "can.log");
  return test::candump_frames(folder.path() / "can.log");
}

TEST(SerialRecording, EveryFrameIsWholeAndItsChecksumRight) {
  const PcapFile pcap = serial(exact_imus());
  EXPECT_EQ(pcap.link_type, 147U);                 // USER0
  EXPECT_EQ(test::imu_frames(pcap).size(), 200U);  // imu_frames throws on any other byte
}

TEST(SerialRecording, CounterWrapsAndTimeStepsByTheRate) {
  for (const std::int64_t hz : {100, 400}) {
    RecordingOptions options = exact_imus();
    options.serial_imu.rate_hz = hz;
    options.serial_imu.baud = 921600;
    const auto frames = test::imu_frames(serial(options));
    ASSERT_EQ(frames.size(), static_cast<std::size_t>(2 * hz));
    bool wrapped = false;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      ASSERT_EQ(static_cast<std::uint16_t>(frames[i].counter - frames[i - 1].counter), 1);
      ASSERT_EQ(frames[i].ticks - frames[i - 1].ticks, 10'000U / static_cast<std::uint32_t>(hz));
      wrapped |= frames[i].counter == 0;
    }
    EXPECT_TRUE(wrapped);
  }
}

TEST(SerialRecording, ReadsAreUnevenAndCutFramesApart) {
  std::set<std::size_t> sizes;
  bool several_frames_touched = false;
  std::size_t at = 0;
  for (const test::PcapRecord& record : serial(exact_imus()).records) {
    sizes.insert(record.bytes.size());
    several_frames_touched |= at / 73 != (at + record.bytes.size() - 1) / 73;
    at += record.bytes.size();
  }
  EXPECT_GT(sizes.size(), 10U);
  EXPECT_TRUE(several_frames_touched);
}

TEST(SerialRecording, NoByteIsReadBeforeTheLineCanHaveBroughtIt) {
  const RecordingOptions options = exact_imus();
  const PcapFile pcap = serial(options);
  std::int64_t previous = 0;
  std::int64_t bytes = 0;
  double least_wait_ms = 1e9;
  for (const test::PcapRecord& record : pcap.records) {
    ASSERT_GT(record.stamp_ns, previous);
    previous = record.stamp_ns;
    bytes += static_cast<std::int64_t>(record.bytes.size());
    const std::int64_t last = bytes - 1;
    const std::int64_t sample = last / 73;
    const std::int64_t byte = last % 73;
    const double on_line_ms =
        static_cast<double>(sample) * 10.0 + static_cast<double>(byte + 1) * 10.0 / 115.2;
    const double waited = static_cast<double>(record.stamp_ns - kStartNs) * 1e-6 - on_line_ms;
    ASSERT_GT(waited, 0.0);
    least_wait_ms = std::min(least_wait_ms, waited);
  }
  EXPECT_LT(least_wait_ms, 0.5);  // some reads are prompt: what a clock filter lives on
}

TEST(SerialRecording, ValuesAreTheRigs) {
  const RecordingOptions options = exact_imus();
  const RigMotion motion(options.motion);
  const auto frames = test::imu_frames(serial(options));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RigState rig = motion.state(10ms * static_cast<std::int64_t>(i));
    const Quaternion& q = rig.q_level_from_imu;
    EXPECT_NEAR(static_cast<double>(frames[i].wxyz[0]), q.w(), 1e-6);
    EXPECT_NEAR(static_cast<double>(frames[i].wxyz[1]), q.x(), 1e-6);
    EXPECT_NEAR(static_cast<double>(frames[i].wxyz[2]), q.y(), 1e-6);
    EXPECT_NEAR(static_cast<double>(frames[i].wxyz[3]), q.z(), 1e-6);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto j = static_cast<Eigen::Index>(axis);
      EXPECT_NEAR(static_cast<double>(frames[i].rate[axis]), rig.angular_velocity_rad_s[j], 1e-6);
      EXPECT_NEAR(static_cast<double>(frames[i].acceleration[axis]), rig.specific_force_m_s2[j],
                  1e-5);
    }
    EXPECT_EQ(frames[i].status, 0x00400003U);
  }
}

TEST(SerialRecording, AFastDeviceClockShowsInTheArrivals) {
  RecordingOptions options = exact_imus();
  options.serial_imu.clock.fast_by_ppm = 10'000.0;  // 1 %
  // 2 s of the device are 1.98 s of the host: the last frame's arrival tells.
  const std::int64_t last = serial(options).records.back().stamp_ns - kStartNs;
  EXPECT_NEAR(static_cast<double>(last) * 1e-9, 1.99 / 1.01 + 0.0065, 0.006);
}

TEST(SerialRecording, BeginsBeforeTheLidarAndEndsAfterIt) {
  RecordingOptions options = exact_imus();
  options.imu_margin = 200ms;
  const PcapFile pcap = serial(options);
  const auto frames = test::imu_frames(pcap);
  EXPECT_EQ(frames.size(), 240U);
  const RigMotion motion(options.motion);
  EXPECT_NEAR(static_cast<double>(frames.front().wxyz[3]), motion.q_level_from_rig(-200ms).z(),
              1e-6);
  EXPECT_LT(pcap.records.front().stamp_ns, kStartNs - 180'000'000);
  EXPECT_GT(pcap.records.back().stamp_ns, kStartNs + 2'180'000'000);
}

TEST(CanRecording, AGroupIsTimeCounterAndTheThreeValues) {
  const auto frames = can(exact_imus());
  ASSERT_EQ(frames.size(), 200U * 5);
  constexpr std::uint32_t kIds[] = {0x005, 0x006, 0x021, 0x032, 0x034};
  constexpr std::size_t kSizes[] = {4, 2, 8, 6, 6};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_EQ(frames[i].id, kIds[i % 5]);
    ASSERT_EQ(frames[i].data.size(), kSizes[i % 5]);
  }
}

TEST(CanRecording, SampleTimeStepsByTheRateAndStampsNeverGoBack) {
  const auto frames = can(exact_imus());
  const auto micros = [&](std::size_t group) {
    const auto& d = frames[5 * group].data;
    return std::uint32_t{d[0]} << 24U | std::uint32_t{d[1]} << 16U | std::uint32_t{d[2]} << 8U |
           d[3];
  };
  for (std::size_t i = 1; i < frames.size() / 5; ++i) ASSERT_EQ(micros(i) - micros(i - 1), 10'000U);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    ASSERT_GT(frames[i].stamp_us, frames[i - 1].stamp_us);
  }
}

TEST(CanRecording, OrientationIsThatOfTheSerialImuWithinResolution) {
  const auto serial_frames = test::imu_frames(serial(exact_imus()));
  const auto can_frames = can(exact_imus());
  ASSERT_EQ(can_frames.size(), 5 * serial_frames.size());
  for (std::size_t i = 0; i < serial_frames.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      const double from_can = can_frames[5 * i + 2].i16(k) / 32767.0;
      ASSERT_NEAR(from_can, static_cast<double>(serial_frames[i].wxyz[k]), 0.5 / 32767 + 1e-6);
    }
  }
}

TEST(CanRecording, RatesAndAccelerationsHaveTheirScales) {
  const RecordingOptions options = exact_imus();
  const RigMotion motion(options.motion);
  const auto frames = can(options);
  for (std::size_t i = 0; i < frames.size() / 5; ++i) {
    const RigState rig = motion.state(10ms * static_cast<std::int64_t>(i));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto j = static_cast<Eigen::Index>(k);
      ASSERT_NEAR(frames[5 * i + 3].i16(k) / 512.0, rig.angular_velocity_rad_s[j],
                  0.5 / 512 + 1e-9);
      ASSERT_NEAR(frames[5 * i + 4].i16(k) / 256.0, rig.specific_force_m_s2[j], 0.5 / 256 + 1e-9);
    }
  }
}

TEST(MaxRate, IsWhatTheLineCarries) {
  EXPECT_EQ(simulation::max_rate_hz(115200), 157);
  EXPECT_GE(simulation::max_rate_hz(460800), 400);
}

}  // namespace
}  // namespace convexcut::sim
