// SPDX-License-Identifier: Apache-2.0
//
// lidar.pcap, decoded independently: byte layout, clock, rotor, and ranges against plane geometry.
// Not proved: that a real HDL-32E looks like this (the layout comes from its manual and from real
// captures), nor that noise and dropouts are distributed as in a real one.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/demo_room/recording.hpp"
#include "tests/apps/demo_room/mini_decoder.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::sim {
namespace {

using namespace std::chrono_literals;
using test::MiniDataPacket;
using test::PcapFile;
using test::TemporaryDirectory;

// Seconds from the first packet to the hour, in the demo's time.
constexpr Duration kToTheHour = 2s;

RecordingOptions exact_lidar() {
  RecordingOptions options;
  options.length = 150ms;
  options.furnishing = Furnishing::empty;
  options.lidar.noise_m = 0.0;
  options.lidar.dropout = 0.0;
  return options;
}

PcapFile recorded(const RecordingOptions& options) {
  const TemporaryDirectory folder;
  write_lidar(options, folder.path() / "lidar.pcap", {});
  return test::read_pcap(folder.path() / "lidar.pcap");
}

std::vector<MiniDataPacket> packets(const RecordingOptions& options) {
  return test::data_packets(recorded(options));
}

TEST(LidarRecording, HoldsTheTwoDatagramsOfTheSensor) {
  const PcapFile pcap = recorded(exact_lidar());
  EXPECT_EQ(pcap.link_type, 1U);  // Ethernet
  std::size_t data = 0;
  std::size_t position = 0;
  for (const test::MiniDatagram& datagram : test::datagrams(pcap)) {
    if (datagram.destination_port == 2368) {
      EXPECT_EQ(datagram.payload.size(), 1206U);
      ++data;
    } else {
      EXPECT_EQ(datagram.destination_port, 8308);
      EXPECT_EQ(datagram.payload.size(), 512U);
      ++position;
    }
  }
  EXPECT_EQ(data, 271U);  // 150 ms / 552.96 µs
  EXPECT_EQ(position, 30U);
}

TEST(LidarRecording, EveryBlockIsFlaggedAndThePacketSaysWhatItIs) {
  for (const MiniDataPacket& packet : packets(exact_lidar())) {
    for (const test::MiniBlock& block : packet.blocks) ASSERT_EQ(block.flag, 0xEEFF);
    ASSERT_EQ(packet.mode, 0x37);
    ASSERT_EQ(packet.product, 0x21);
  }
}

TEST(LidarRecording, TheCounterStepsAsInRealCaptures) {
  const auto all = packets(exact_lidar());
  int long_steps = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const std::uint32_t step = all[i].timestamp_us - all[i - 1].timestamp_us;
    ASSERT_TRUE(step == 552 || step == 553) << step;
    long_steps += step == 553 ? 1 : 0;
  }
  EXPECT_NEAR(long_steps / static_cast<double>(all.size()), 0.96, 0.01);
}

TEST(LidarRecording, TheCounterWrapsAtTheHour) {
  RecordingOptions options = exact_lidar();
  options.length = kToTheHour + 20ms;
  const auto all = packets(options);
  EXPECT_EQ(all.front().timestamp_us, 3'598'000'000U);
  EXPECT_LT(all.back().timestamp_us, 20'000U);
  for (std::size_t i = 1; i < all.size(); ++i) {
    const std::uint32_t step =
        (all[i].timestamp_us + 3'600'000'000U - all[i - 1].timestamp_us) % 3'600'000'000U;
    ASSERT_TRUE(step == 552 || step == 553) << step;
  }
}

TEST(LidarRecording, TheRotorTurnsClockwiseAtItsRate) {
  for (const double hz : {5.0, 10.0, 20.0}) {
    RecordingOptions options = exact_lidar();
    options.lidar.rotor_hz = hz;
    const double step = 46.08e-6 * hz * 36000.0;
    int previous = -1;
    for (const MiniDataPacket& packet : packets(options)) {
      for (const test::MiniBlock& block : packet.blocks) {
        ASSERT_LE(block.azimuth, 36000);
        if (previous >= 0) {
          ASSERT_NEAR((block.azimuth - previous + 36000) % 36000, step, 1.0);
        }
        previous = block.azimuth;
      }
    }
  }
}

TEST(LidarRecording, NoPacketArrivesBeforeItsLastFiringAndNoneOvertakes) {
  const PcapFile pcap = recorded(exact_lidar());
  std::int64_t previous = 0;
  for (const test::PcapRecord& record : pcap.records) {
    ASSERT_GT(record.stamp_ns, previous);
    previous = record.stamp_ns;
  }
  for (const MiniDataPacket& packet : test::data_packets(pcap)) {
    // PPS: the counter is UTC, to the microsecond below.
    const std::int64_t in_hour_ns = packet.stamp_ns % 3'600'000'000'000;
    const std::int64_t delay = in_hour_ns - std::int64_t{packet.timestamp_us} * 1000;
    ASSERT_GT(delay, 552'960);
    ASSERT_LT(delay, 1'000'000);
  }
}

// The manual's elevations by firing order.
double elevation_deg(std::size_t laser) {
  const std::size_t ring = laser % 2 == 0 ? laser / 2 : 16 + laser / 2;
  return std::round((-30.0 - 2.0 / 3.0 + 4.0 / 3.0 * static_cast<double>(ring)) * 100.0) / 100.0;
}

// From a point inside the empty demo room along a direction to its shell.
double to_shell(const Vec3& direction_level) {
  const Vec3 low(-3.6, -2.9, -1.2);
  const Vec3 high(5.4, 4.1, 1.5);
  double range = HUGE_VAL;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double side = direction_level[i] > 0 ? high[i] : low[i];
    range = std::min(range, side / direction_level[i]);
  }
  return range;
}

// Calls use(range in metres, true range) for every laser of every packet.
template <class Use>
void for_each_range(const RecordingOptions& options, Use&& use) {
  const RigMotion motion(options.motion);
  const auto all = packets(options);
  for (std::size_t p = 0; p < all.size(); ++p) {
    for (std::size_t b = 0; b < 12; ++b) {
      const std::size_t from =
          std::min<std::size_t>(b, 10);  // the last block takes the step before
      const int step =
          (all[p].blocks[from + 1].azimuth - all[p].blocks[from].azimuth + 36000) % 36000;
      for (std::size_t c = 0; c < 32; ++c) {
        const double share = 1.152 * static_cast<double>(c) / 46.08;
        const double azimuth =
            (all[p].blocks[b].azimuth + step * share) * 0.01 * std::numbers::pi / 180.0;
        const double elevation = elevation_deg(c) * std::numbers::pi / 180.0;
        const Vec3 lidar(std::cos(elevation) * std::cos(azimuth),
                         -std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const Duration fired{static_cast<std::int64_t>(p) * 552'960 +
                             static_cast<std::int64_t>(b) * 46'080 +
                             static_cast<std::int64_t>(c) * 1'152};
        use(all[p].blocks[b].distance[c] * 0.002, to_shell(motion.q_level_from_rig(fired) * lidar));
      }
    }
  }
}

TEST(LidarRecording, RangesAreThoseOfTheRoom) {
  // 1 mm of rounding to 2 mm, and 1 mm for the azimuth's rounding to 0.01° on slanting walls.
  double worst = 0.0;
  int count = 0;
  for_each_range(exact_lidar(), [&](double range, double truth) {
    worst = std::max(worst, std::abs(range - truth));
    ++count;
  });
  EXPECT_EQ(count, 271 * 384);
  EXPECT_LT(worst, 0.002);
}

TEST(LidarRecording, LeaningRigsSeeTheSameRoom) {
  RecordingOptions options = exact_lidar();
  options.motion.tilt = Degrees{20.0};
  options.motion.turn_per_second = Degrees{90.0};
  double worst = 0.0;
  double sum = 0.0;
  int count = 0;
  for_each_range(options, [&](double range, double truth) {
    worst = std::max(worst, std::abs(range - truth));
    sum += std::abs(range - truth);
    ++count;
  });
  EXPECT_LT(worst, 0.004);
  EXPECT_LT(sum / count, 0.0008);
}

TEST(LidarRecording, NoiseAndDropoutAreAsAskedFor) {
  RecordingOptions options = exact_lidar();
  options.lidar.noise_m = 0.02;
  options.lidar.dropout = 0.03;
  double sum = 0.0;
  double squares = 0.0;
  int returns = 0;
  int lost = 0;
  for_each_range(options, [&](double range, double truth) {
    if (range == 0.0) {
      ++lost;
      return;
    }
    ++returns;
    sum += range - truth;
    squares += (range - truth) * (range - truth);
  });
  // 104,064 draws: five standard errors.
  EXPECT_NEAR(sum / returns, 0.0, 5 * 0.02 / std::sqrt(returns));
  EXPECT_NEAR(std::sqrt(squares / returns), 0.02, 5 * 0.02 / std::sqrt(2.0 * returns) + 5e-5);
  EXPECT_NEAR(lost / (1.0 * (returns + lost)), 0.03, 5 * std::sqrt(0.03 * 0.97 / returns));
}

// --- position packets

std::vector<test::MiniDatagram> positions(const RecordingOptions& options) {
  std::vector<test::MiniDatagram> out;
  for (const test::MiniDatagram& datagram : test::datagrams(recorded(options))) {
    if (datagram.destination_port == 8308) out.push_back(datagram);
  }
  return out;
}

std::string sentence(const test::MiniDatagram& position) {
  std::string text;
  for (std::size_t i = 206; i < 512 && position.payload[i] != 0; ++i) {
    text.push_back(static_cast<char>(position.payload[i]));
  }
  return text;
}

std::uint32_t timestamp(const test::MiniDatagram& position) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= std::uint32_t{position.payload[198 + i]} << (8 * i);
  }
  return value;
}

TEST(LidarRecording, PositionPacketsTellTheTimeOfALockedSensor) {
  const auto all = positions(exact_lidar());
  ASSERT_FALSE(all.empty());
  for (const test::MiniDatagram& position : all) {
    EXPECT_EQ(position.payload[202], 2);  // PPS locked
    EXPECT_THAT(sentence(position), testing::StartsWith("$GPRMC,095958,A,"));
    EXPECT_THAT(sentence(position), testing::HasSubstr(",010326,"));
    EXPECT_THAT(sentence(position), testing::EndsWith("\r\n"));
    const std::int64_t delay =
        position.stamp_ns % 3'600'000'000'000 - std::int64_t{timestamp(position)} * 1000;
    EXPECT_GT(delay, 0);
    EXPECT_LT(delay, 1'000'000);
  }
}

TEST(LidarRecording, SentencesHaveTheirChecksum) {
  const std::string text = sentence(positions(exact_lidar()).front());
  const std::size_t star = text.find('*');
  ASSERT_EQ(star + 5, text.size());
  int sum = 0;
  for (std::size_t i = 1; i < star; ++i) sum ^= text[i];
  EXPECT_EQ(std::stoi(text.substr(star + 1, 2), nullptr, 16), sum);
}

TEST(LidarRecording, MotionSensorsReadAnUprightHousing) {
  const test::ByteString payload = positions(exact_lidar()).front().payload;
  const auto word = [&](std::size_t at) { return payload[at] | payload[at + 1] << 8; };
  EXPECT_EQ(word(14), 0x0000);        // gyro 1
  EXPECT_EQ(word(16), 0x1000);        // temperature 1, 25 °C
  EXPECT_EQ(word(18), 0x2000 | 819);  // accelerometer 1 X, 1 g
  EXPECT_EQ(word(20), 0x3000);        // accelerometer 1 Y
}

TEST(LidarRecording, WithoutPpsTheCounterIsNotUtcAndSaysSo) {
  RecordingOptions options = exact_lidar();
  options.pps = PpsState::absent;
  EXPECT_EQ(packets(options).front().timestamp_us, 754'321'000U);
  for (const test::MiniDatagram& position : positions(options)) {
    EXPECT_EQ(position.payload[202], 0);
    EXPECT_THAT(sentence(position), testing::HasSubstr(",V,"));
  }
}

// --- determinism

std::vector<std::byte> whole(const RecordingOptions& options, const std::string& name) {
  const TemporaryDirectory folder;
  write_recording(options, folder.path() / "made" / "here", {});
  return test::read_bytes(folder.path() / "made" / "here" / name);
}

class Files : public testing::TestWithParam<const char*> {};

TEST_P(Files, TheSameOptionsGiveTheSameBytes) {
  RecordingOptions options;
  options.length = 60ms;
  const auto first = whole(options, GetParam());
  EXPECT_GT(first.size(), 100U);
  EXPECT_EQ(first, whole(options, GetParam()));
}

TEST_P(Files, AnotherSeedGivesOtherBytes) {
  RecordingOptions options;
  options.length = 60ms;
  RecordingOptions other = options;
  other.seed = 2;
  EXPECT_NE(whole(options, GetParam()), whole(other, GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Recording, Files, testing::Values("lidar.pcap", "imu.pcap", "can.log"));

}  // namespace
}  // namespace convexcut::sim
