// SPDX-License-Identifier: Apache-2.0
//
// The files of a simulation against its truth, by the drivers and by plain decoders of their own.
// Not proved: the timing of a real network, line or bus, nor that a real HDL-32E looks like this.
#include "replay/simulation/recording.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/velodyne/decoder.hpp"
#include "drivers/velodyne/model.hpp"
#include "replay/simulation/truth/truth_reader.hpp"
#include "tests/apps/demo_room/mini_decoder.hpp"
#include "tests/replay/simulation/scenes.hpp"
#include "tests/support/output_of.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::simulation {
namespace {

using namespace std::chrono_literals;
using convexcut::test::MiniDataPacket;
using convexcut::test::TemporaryDirectory;
using test::empty_room;

constexpr auto kSilent = [](std::uint64_t, std::uint64_t) {};

SimulationOptions tilted(const Scene& scene, Duration length) {
  SimulationOptions options;
  options.length = length;
  options.rig = planned_rig(scene, false);
  options.rig.tilt = Degrees{25};
  options.rig.rotation_per_second = Degrees{45};
  return options;
}

// A recording of a room, and its truth.
struct Recorded {
  explicit Recorded(const SimulationOptions& options, const Scene& scene = empty_room())
      : summary(write_recording(scene, options, folder.path(), kSilent)), truth(folder.path()) {}
  TemporaryDirectory folder;
  RecordingSummary summary;
  TruthReader truth;
};

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Recording, ThePlainDecoderFindsTheTruthOfEveryReturn) {
  const Scene scene = empty_room();
  const Recorded r(tilted(scene, 60ms), scene);
  const auto packets =
      convexcut::test::data_packets(convexcut::test::read_pcap(r.folder.path() / "lidar.pcap"));
  ASSERT_EQ(packets.size(), 108U);
  ASSERT_EQ(r.truth.firings(), 108U * 12);
  for (std::size_t p = 0; p < packets.size(); ++p) {
    for (std::size_t b = 0; b < 12; ++b) {
      const TrueFiring firing = r.truth.firing(p * 12 + b);
      ASSERT_EQ(packets[p].blocks[b].azimuth * Azimuth::kPerCentidegree,
                firing.azimuth().microdegrees());
      // PPS: the counter is UTC, cut to the microsecond.
      const std::int64_t in_hour_ns =
          std::int64_t{packets[p].timestamp_us} * 1000 + static_cast<std::int64_t>(b) * 46'080;
      const std::int64_t late = to_ns(firing.time()) % 3'600'000'000'000 - in_hour_ns;
      ASSERT_TRUE(late >= 0 && late < 1000) << late;
      for (std::size_t c = 0; c < 32; ++c) {
        ASSERT_EQ(packets[p].blocks[b].distance[c], firing.at(0, c).range_2mm);
      }
    }
  }
}

// Directions and ranges that the driver's decoder makes of the packets, held against geometry: the
// room's sides seen from the true pose at the laser's own time.
TEST(Recording, TheDecoderFindsTheBeamsWithinAThousandthOfADegree) {
  const Scene scene = empty_room();
  SimulationOptions options = tilted(scene, 60ms);
  options.lidar.noise_m = 0.0;
  options.lidar.divergence = {0.0};
  const Recorded r(options, scene);
  const RigMotion motion(options.rig, options.seed);
  const velodyne::DataDecoder decoder(velodyne::model_of(velodyne::ModelId::hdl32e));
  ReturnBatch batch;
  double worst_range = 0.0;
  std::size_t returns = 0;
  const auto pcap = convexcut::test::read_pcap(r.folder.path() / "lidar.pcap");
  std::int64_t first_firing_ns = 0;
  for (const auto& datagram : convexcut::test::datagrams(pcap)) {
    if (datagram.destination_port != 2368) continue;
    ASSERT_EQ(decoder.decode(std::as_bytes(std::span(datagram.payload)), {}, batch),
              velodyne::DecodeStatus::ok);
    for (std::size_t i = 0; i < batch.return_count; ++i) {
      const Pose pose = motion.pose_at(Duration{first_firing_ns + batch.offset_ns[i]});
      const Vec3 p = Vec3f(batch.x_lidar[i], batch.y_lidar[i], batch.z_lidar[i]).cast<double>();
      const Vec3 direction = pose.q_world_from_lidar * p.normalized();
      const double range = test::to_side(pose.position_world, direction, Vec3::Zero(), test::kRoom);
      worst_range = std::max(worst_range, std::abs(range - p.norm()));
      ++returns;
    }
    first_firing_ns += 552'960;
  }
  EXPECT_GT(returns, 40'000U);
  // 1 mm of rounding to 2 mm. A beam that is off by 0.001° is off by 0.1 mm on a wall that it meets
  // at a right angle 6 m away, and by 0.6 mm where it meets it at 10°.
  EXPECT_LT(worst_range, 0.00105);
}

TEST(Recording, ImuFramesHoldTheMotionAtTheirOwnTimes) {
  const Scene scene = empty_room();
  SimulationOptions options = tilted(scene, 60ms);
  options.imu_errors = kIdealImu;
  const Recorded r(options, scene);
  const RigMotion motion(options.rig, options.seed);
  const auto frames =
      convexcut::test::imu_frames(convexcut::test::read_pcap(r.folder.path() / "imu.pcap"));
  ASSERT_EQ(frames.size(), 184U);  // 460 ms at 400 Hz
  for (const auto& frame : frames) {
    // The device counts tenths of milliseconds from somewhere; its clock is 20 ppm fast.
    const Duration counted = 100us * (frame.ticks - frames.front().ticks);
    const Duration sampled = -options.imu_margin + options.serial_imu.clock.true_time(counted);
    const Quaternion truth = motion.pose_at(sampled).q_world_from_lidar;
    const Quaternion told =
        Eigen::Quaternionf(frame.wxyz[0], frame.wxyz[1], frame.wxyz[2], frame.wxyz[3])
            .cast<double>();
    // Floats; 1 µs at 45 °/s would be 8e-7 rad.
    ASSERT_LT(truth.angularDistance(told.normalized()), 4e-7);
    ASSERT_NEAR(static_cast<double>(frame.rate[2]),
                Degrees{45}.to_radians().value * std::cos(25 * std::numbers::pi / 180), 0.06);
  }
}

TEST(Recording, CanFramesHoldTheMotionAtTheirOwnTimes) {
  const Scene scene = empty_room();
  SimulationOptions options = tilted(scene, 60ms);
  options.imu_errors = kIdealImu;
  const Recorded r(options, scene);
  const RigMotion motion(options.rig, options.seed);
  const auto frames = convexcut::test::candump_frames(r.folder.path() / "can.log");
  ASSERT_EQ(frames.size(), 46U * 5);  // five frames a sample, 100 Hz
  std::uint32_t first_us = 0;
  for (std::size_t i = 0; i < frames.size(); i += 5) {
    ASSERT_EQ(frames[i].id, 0x005U);
    ASSERT_EQ(frames[i + 2].id, 0x021U);
    std::uint32_t micros = 0;
    for (const std::uint8_t byte : frames[i].data) micros = micros << 8U | byte;
    if (i == 0) first_us = micros;
    const Duration sampled =
        -options.imu_margin + options.can_imu.clock.true_time(1us * (micros - first_us));
    const Quaternion truth = motion.pose_at(sampled).q_world_from_lidar;
    const Quaternion told(frames[i + 2].i16(0), frames[i + 2].i16(1), frames[i + 2].i16(2),
                          frames[i + 2].i16(3));
    ASSERT_LT(truth.angularDistance(told.normalized()), 2.0 / 32767);
  }
}

TEST(Recording, TsharkFindsTheSamePacketsAndPoints) {
  using convexcut::test::output_of;
  if (output_of("tshark --version 2>/dev/null").empty()) GTEST_SKIP() << "needs tshark";
  const Recorded r(tilted(empty_room(), 30ms));
  const std::string file = (r.folder.path() / "lidar.pcap").string();
  std::istringstream lines(
      output_of("tshark -r " + file +
                " -o ip.check_checksum:TRUE -T fields -e ip.src -e ip.dst -e ip.checksum.status"
                " -e udp.dstport -e udp.length -e data.data -E separator=, 2>/dev/null"));
  std::size_t data_packets = 0;
  std::size_t position_packets = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string head = line.substr(0, line.rfind(',') + 1);
    const std::string payload = line.substr(head.size());
    if (head == "192.168.1.201,255.255.255.255,1,8308,520,") {
      EXPECT_EQ(payload.substr(2 * 206, 12), "244750524d43");  // $GPRMC
      ++position_packets;
      continue;
    }
    ASSERT_EQ(head, "192.168.1.201,255.255.255.255,1,2368,1214,");
    ASSERT_EQ(payload.size(), 2U * 1206);
    const auto byte = [&](std::size_t at) {
      return static_cast<unsigned>(std::stoul(payload.substr(2 * at, 2), nullptr, 16));
    };
    for (std::size_t block = 0; block < 12; ++block) {
      const TrueFiring firing = r.truth.firing(data_packets * 12 + block);
      ASSERT_EQ(byte(block * 100) << 8U | byte(block * 100 + 1), 0xFFEEU);
      for (std::size_t laser = 0; laser < 32; ++laser) {
        const std::size_t at = block * 100 + 4 + 3 * laser;
        ASSERT_EQ(byte(at) | byte(at + 1) << 8U, firing.at(0, laser).range_2mm);
      }
    }
    ++data_packets;
  }
  EXPECT_EQ(data_packets, 54U);
  EXPECT_EQ(position_packets, 6U);
}

TEST(Recording, PacketsAreLostDoubledAndOvertakenAsOften) {
  const Scene scene = empty_room();
  SimulationOptions options = tilted(scene, 1s);
  options.link.loss = 0.1;
  options.link.duplicate = 0.05;
  options.link.reorder = 0.02;
  const Recorded r(options, scene);
  const auto packets =
      convexcut::test::data_packets(convexcut::test::read_pcap(r.folder.path() / "lidar.pcap"));
  std::set<std::uint32_t> seen;
  std::size_t doubles = 0;
  std::size_t overtaken = 0;
  std::uint32_t newest = 0;
  for (const MiniDataPacket& packet : packets) {
    if (!seen.insert(packet.timestamp_us).second) {
      ++doubles;
    } else if (packet.timestamp_us < newest) {
      ++overtaken;
    }
    newest = std::max(newest, packet.timestamp_us);
  }
  const double sent = static_cast<double>(r.summary.packets);
  EXPECT_NEAR(static_cast<double>(seen.size()) / sent, 0.9, 4 * std::sqrt(0.09 / sent));
  EXPECT_NEAR(static_cast<double>(doubles) / sent, 0.9 * 0.05, 4 * std::sqrt(0.05 / sent));
  EXPECT_NEAR(static_cast<double>(overtaken) / sent, 0.9 * 0.02, 4 * std::sqrt(0.02 / sent));
}

TEST(Recording, DualPacketsHoldSixFiringsWithBothReturns) {
  const Scene scene = empty_room();
  SimulationOptions options = tilted(scene, 30ms);
  options.lidar.dual = true;
  const Recorded r(options, scene);
  const auto packets =
      convexcut::test::data_packets(convexcut::test::read_pcap(r.folder.path() / "lidar.pcap"));
  ASSERT_EQ(packets.size(), 108U);
  ASSERT_EQ(r.truth.firings(), 108U * 6);
  ASSERT_TRUE(r.truth.settings().dual);
  for (std::size_t p = 0; p < packets.size(); ++p) {
    ASSERT_EQ(packets[p].mode, 0x39);
    for (std::size_t b = 0; b < 12; ++b) {
      const TrueFiring firing = r.truth.firing(p * 6 + b / 2);
      ASSERT_EQ(packets[p].blocks[b].azimuth * Azimuth::kPerCentidegree,
                firing.azimuth().microdegrees());
      for (std::size_t c = 0; c < 32; ++c) {
        ASSERT_EQ(packets[p].blocks[b].distance[c], firing.at(b % 2, c).range_2mm);
      }
    }
  }
}

TEST(Recording, SameSeedSameBytesAndAnotherSeedOthers) {
  const Scene scene = empty_room();
  SimulationOptions options = tilted(scene, 30ms);
  const Recorded first(options, scene);
  const Recorded second(options, scene);
  options.seed = 2;
  const Recorded other(options, scene);
  for (const char* file : {"lidar.pcap", "imu.pcap", "can.log", "truth/returns.bin",
                           "truth/poses.csv", "truth/simulation.toml"}) {
    EXPECT_EQ(bytes_of(first.folder.path() / file), bytes_of(second.folder.path() / file)) << file;
  }
  for (const char* file : {"lidar.pcap", "imu.pcap", "can.log", "truth/returns.bin"}) {
    EXPECT_NE(bytes_of(first.folder.path() / file), bytes_of(other.folder.path() / file)) << file;
  }
}

TEST(Truth, SaysWhatWasSimulated) {
  const Scene scene = empty_room();
  SimulationOptions options = tilted(scene, 20ms);
  options.seed = 77;
  const Recorded r(options, scene);
  EXPECT_EQ(r.truth.settings().seed, 77U);
  EXPECT_EQ(r.truth.settings().scene, scene.name());
  EXPECT_EQ(r.truth.settings().start, kStart);
  ASSERT_EQ(r.truth.settings().surfaces.size(), scene.surfaces().size());
  EXPECT_EQ(r.truth.settings().surfaces.back().name, scene.surfaces().back().name);
  EXPECT_EQ(r.truth.settings().surfaces.front().label, SurfaceLabel::structure);
}

TEST(Truth, PosesAreThoseOfTheRig) {
  const Scene scene = empty_room();
  const SimulationOptions options = tilted(scene, 20ms);
  const Recorded r(options, scene);
  const RigMotion motion(options.rig, options.seed);
  for (const Duration t : {0ms, 7ms, 19ms}) {
    const Pose read = r.truth.pose_at(kStart + t);
    const Pose expected = motion.pose_at(t);
    EXPECT_LT((read.position_world - expected.position_world).norm(), 1e-8);
    EXPECT_LT(read.q_world_from_lidar.angularDistance(expected.q_world_from_lidar), 1e-7);
  }
}

TEST(Truth, FindsTheFiringOfATime) {
  const Recorded r(tilted(empty_room(), 20ms));
  EXPECT_EQ(r.truth.firing_at(kStart - 1s), 0U);
  EXPECT_EQ(r.truth.firing_at(kStart + 46'080ns * 100), 100U);
  EXPECT_EQ(r.truth.firing_at(kStart + 46'080ns * 101 - 1ns), 100U);
  EXPECT_EQ(r.truth.firing_at(kStart + 1h), r.truth.firings() - 1);
}

std::string truth_error(const std::filesystem::path& folder) {
  try {
    const TruthReader reader(folder);
  } catch (const TruthError& error) {
    return error.what();
  }
  return "";
}

void overwrite(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(Truth, FilesThatAreMissingCutOrOfAnotherRunAreRefusedInOneLine) {
  using ::testing::HasSubstr;
  const Recorded r(tilted(empty_room(), 20ms));
  const std::filesystem::path truth = r.folder.path() / "truth";
  EXPECT_THAT(truth_error(r.folder.path() / "nowhere"), HasSubstr("simulation.toml"));
  const std::string returns = bytes_of(truth / "returns.bin");
  overwrite(truth / "returns.bin", returns.substr(0, returns.size() - 5));
  EXPECT_THAT(truth_error(truth), HasSubstr("returns.bin: expected 432 firings"));
  overwrite(truth / "returns.bin", "PNG" + returns.substr(3));
  EXPECT_THAT(truth_error(truth), HasSubstr("found something else"));
  overwrite(truth / "returns.bin", "");
  EXPECT_THAT(truth_error(truth), HasSubstr("is empty"));
  overwrite(truth / "returns.bin", returns);
  const std::string poses = bytes_of(truth / "poses.csv");
  overwrite(truth / "poses.csv", poses + "12,0,0\n");
  EXPECT_THAT(truth_error(truth), HasSubstr("poses.csv:17"));
  overwrite(truth / "poses.csv", poses);
  const std::string settings = bytes_of(truth / "simulation.toml");
  overwrite(truth / "simulation.toml", settings + "\n[[[");
  EXPECT_THAT(truth_error(truth), HasSubstr("simulation.toml:"));
  overwrite(truth / "simulation.toml", "format = 2\n");
  EXPECT_THAT(truth_error(truth), HasSubstr("expected 1, found 2"));
}

}  // namespace
}  // namespace convexcut::simulation
