// SPDX-License-Identifier: Apache-2.0
//
// A lidar on a turning stage through `convexcut process`: frames of an encoder among those of the
// IMU. Does not prove how a real stage's axis lies: the generated rig turns about the lidar's
// origin.
#include <array>
#include <cmath>
#include <functional>
#include <sstream>

#include <gmock/gmock.h>

#include "core/geometry.hpp"
#include "core/scan/stage.hpp"
#include "drivers/can/candump_reader.hpp"
#include "drivers/can/socketcan_layout.hpp"
#include "drivers/capture/capture_writer.hpp"
#include "drivers/wire.hpp"
#include "replay/pcd_reader.hpp"
#include "tests/support/room.hpp"

namespace convexcut::test {
namespace {

using ::testing::HasSubstr;

constexpr std::uint32_t kSampleTime = 0x005;
constexpr std::uint32_t kQuaternion = 0x021;
constexpr std::uint32_t kEncoder = 0x183;
constexpr double kQuaternionUnit = 1.0 / 32767.0;
constexpr double kCountDegrees = 0.0005;

using Frames = std::vector<can::CanFrame>;

Quaternion quaternion_of(const can::CanFrame& frame) {
  const auto part = [&frame](std::size_t i) {
    return kQuaternionUnit * wire::load_be<std::int16_t>(frame.payload(), 2 * i);
  };
  return Quaternion(part(0), part(1), part(2), part(3)).normalized();
}

void set_quaternion(can::CanFrame& frame, const Quaternion& q) {
  const std::array<double, 4> parts{q.w(), q.x(), q.y(), q.z()};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    wire::store_be<std::int16_t>(
        frame.data, 2 * i, static_cast<std::int16_t>(std::lround(parts[i] / kQuaternionUnit)));
  }
}

// Statusword and position actual value, as the preset cia402_position has them.
can::CanFrame drive_frame(HostTime stamp, Degrees angle) {
  can::CanFrame frame;
  frame.stamp = stamp;
  frame.id = kEncoder;
  frame.length = 6;
  wire::store_le<std::uint16_t>(frame.data, 0, 0x0637);
  wire::store_le<std::int32_t>(frame.data, 2,
                               static_cast<std::int32_t>(std::lround(angle.value / kCountDegrees)));
  return frame;
}

// An extended, big-endian frame of 12 bits in tenths of a degree that count the other way, in the
// middle of others.
can::CanFrame odd_frame(HostTime stamp, Degrees angle) {
  can::CanFrame frame;
  frame.stamp = stamp;
  frame.id = 0x18FF0102;
  frame.extended = true;
  frame.length = 4;
  const auto count = static_cast<unsigned>(std::lround(-10.0 * angle.value)) & 0xFFFU;
  frame.data = {std::byte{0xA5}, static_cast<std::byte>(0xF0U | count >> 8U),
                static_cast<std::byte>(count), std::byte{0x5A}};
  return frame;
}

std::string candump_line(const can::CanFrame& frame) {
  const std::int64_t us = to_ns(frame.stamp) / 1000;
  std::array<char, 80> start{};
  std::snprintf(start.data(), start.size(),
                frame.extended ? "(%lld.%06lld) can0 %08X#" : "(%lld.%06lld) can0 %03X#",
                static_cast<long long>(us / 1'000'000), static_cast<long long>(us % 1'000'000),
                frame.id);
  std::string line = start.data();
  for (const std::byte b : frame.payload()) {
    std::snprintf(start.data(), start.size(), "%02X", std::to_integer<unsigned>(b));
    line += start.data();
  }
  return line + "\n";
}

class Encoder : public RoomTest {
 protected:
  [[nodiscard]] Frames bus() const {
    can::CandumpReader reader(can());
    Frames frames;
    can::CanFrame frame;
    while (reader.next(frame) == can::CandumpReader::Status::frame) frames.push_back(frame);
    return frames;
  }

  // Behind each SampleTime the angle of the stage at that time, which is the IMU's heading.
  using MakeFrame = can::CanFrame (*)(HostTime, Degrees);
  [[nodiscard]] Frames with_encoder(MakeFrame make) const {
    Frames all = bus();
    Frames mixed;
    double turns = 0.0;
    double last = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      mixed.push_back(all[i]);
      if (all[i].id != kSampleTime) continue;
      std::size_t q = i;
      while (q < all.size() && all[q].id != kQuaternion) ++q;
      if (q == all.size()) break;
      const double angle = to_degrees(heading(quaternion_of(all[q]))).value;
      if (angle < last - 180.0) turns += 360.0;
      last = angle;
      mixed.push_back(make(all[i].stamp, Degrees{angle + turns}));
    }
    return mixed;
  }

  std::string write_log(const Frames& frames) const {
    std::string log;
    for (const can::CanFrame& frame : frames) log += candump_line(frame);
    write(path("bus.log"), log);
    return path("bus.log").string();
  }

  std::string write_capture(const Frames& frames) const {
    capture::CaptureWriter writer(path("bus.pcap"), capture::LinkKind::can);
    for (const can::CanFrame& frame : frames) {
      std::array<std::byte, can::kClassicRecordSize> record{};
      wire::store_be<std::uint32_t>(record, can::kSocketCanIdOffset,
                                    frame.id | (frame.extended ? can::kExtendedFlag : 0U));
      record[can::kSocketCanLengthOffset] = std::byte{frame.length};
      std::copy_n(frame.data.begin(), frame.length, record.begin() + can::kSocketCanDataOffset);
      writer.write({.stamp = frame.stamp, .kind = capture::RecordKind::can, .payload = record});
    }
    writer.close();
    return path("bus.pcap").string();
  }

  [[nodiscard]] ProgramResult run(const std::string& bus_file,
                                  const std::vector<std::string>& settings) const {
    std::filesystem::remove_all(out());
    std::vector<std::string> arguments{"--lidar", lidar(), "--can", bus_file};
    for (const std::string& setting : settings) {
      arguments.insert(arguments.end(), {"--set", setting});
    }
    return process(arguments);
  }

  [[nodiscard]] replay::PcdCloud scan(int index) const {
    return replay::read_pcd(path("scans") / ("scan_00000" + std::to_string(index) + ".pcd"));
  }
  [[nodiscard]] std::string all_bytes() const {
    std::string bytes;
    for (const std::string& name : names(out())) bytes += name + text(path("scans") / name);
    return bytes;
  }

  // How far the same returns lie apart at most.
  static double greatest_distance(const replay::PcdCloud& a, const replay::PcdCloud& b) {
    EXPECT_EQ(a.x.size(), b.x.size());
    EXPECT_GT(a.x.size(), 50'000U);
    float greatest = 0.0F;
    for (std::size_t i = 0; i < std::min(a.x.size(), b.x.size()); ++i) {
      greatest = std::max(greatest, std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i], a.z[i] - b.z[i]));
    }
    return static_cast<double>(greatest);
  }

  const std::vector<std::string> drive_settings{
      "encoder.preset=cia402_position", "encoder.id=0x183",
      "encoder.scale_deg=" + std::to_string(kCountDegrees)};
  static std::vector<std::string> and_also(std::vector<std::string> settings,
                                           const std::vector<std::string>& more) {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
  }
};

// A hundredth of a degree at 9 m, which the IMU's and the encoder's resolution amount to.
constexpr double kResolution_m = 0.005;

TEST_F(Encoder, GivesTheHeadingThatTheImuHasLost) {
  make_room({"--seconds", "0.5", "--turn-deg-s", "60"});
  ASSERT_EQ(run(can(), {}).status, 0);
  const replay::PcdCloud truth = scan(2);

  // The IMU's heading is off by 40°, and more with every sample.
  Frames frames = with_encoder(drive_frame);
  double drift = 40.0;
  for (can::CanFrame& frame : frames) {
    if (frame.id != kQuaternion) continue;
    const Quaternion turned =
        to_quaternion({Degrees{0}, Degrees{0}, Degrees{drift += 0.5}}) * quaternion_of(frame);
    set_quaternion(frame, turned);
  }
  const std::string file = write_log(frames);
  ASSERT_EQ(run(file, {}).status, 0);
  EXPECT_GT(greatest_distance(scan(2), truth), 1.0) << "the drift is to be seen";
  const ProgramResult corrected = run(file, and_also(drive_settings, {"encoder.use=yaw"}));
  ASSERT_EQ(corrected.status, 0) << corrected.err;
  EXPECT_LT(greatest_distance(scan(2), truth), kResolution_m);
}

TEST_F(Encoder, GivesTheWholeOrientationOnAFixedMount) {
  make_room({"--seconds", "0.5", "--turn-deg-s", "60", "--tilt-deg", "0"});
  ASSERT_EQ(run(can(), {}).status, 0);
  const replay::PcdCloud truth = scan(2);

  Frames frames = with_encoder(drive_frame);
  std::erase_if(frames, [](const can::CanFrame& frame) { return frame.id != kEncoder; });
  const ProgramResult result =
      run(write_log(frames),
          and_also(drive_settings, {"encoder.use=orientation", "mount.orientation=fixed"}));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_LT(greatest_distance(scan(2), truth), kResolution_m);
}

TEST_F(Encoder, AngleZeroOfTheStageIsTheMount) {
  make_room({"--seconds", "0.3", "--turn-deg-s", "0", "--tilt-deg", "0"});
  Frames frames;
  for (const can::CanFrame& frame : bus()) {
    if (frame.id == kSampleTime) frames.push_back(drive_frame(frame.stamp, Degrees{0}));
  }
  const std::string file = write_log(frames);
  const std::vector<std::string> mount{"mount.orientation=fixed", "mount.roll_deg=3",
                                       "mount.pitch_deg=20", "mount.yaw_deg=90"};
  ASSERT_EQ(run(file, mount).status, 0);
  const replay::PcdCloud fixed = scan(1);
  ASSERT_EQ(
      run(file, and_also(and_also(mount, drive_settings), {"encoder.use=orientation"})).status, 0);
  EXPECT_EQ(greatest_distance(scan(1), fixed), 0.0);
  ASSERT_EQ(
      run(file, and_also(and_also(mount, drive_settings),
                         {"encoder.use=orientation", "encoder.axis=tilt", "encoder.offset_deg=15",
                          "mount.pitch_deg=5", "mount.roll_deg=0", "mount.yaw_deg=0"}))
          .status,
      0);
  const replay::PcdCloud tilted = scan(1);
  ASSERT_EQ(run(file, {"mount.orientation=fixed", "mount.pitch_deg=20"}).status, 0);
  EXPECT_LT(greatest_distance(scan(1), tilted), 1e-4);
}

TEST_F(Encoder, AnyLayoutAndEitherFileGiveTheSameScans) {
  make_room({"--seconds", "0.4", "--turn-deg-s", "60"});
  const Frames frames = with_encoder(odd_frame);
  const std::vector<std::string> settings{"encoder.use=yaw",          "encoder.id=0x18ff0102",
                                          "encoder.extended_id=true", "encoder.start_bit=11",
                                          "encoder.length_bits=12",   "encoder.byte_order=motorola",
                                          "encoder.scale_deg=-0.1",   "encoder.timeout_ms=1000"};
  const ProgramResult from_log = run(write_log(frames), settings);
  ASSERT_EQ(from_log.status, 0) << from_log.err;
  const std::string scans = all_bytes();
  const replay::PcdCloud odd = scan(2);
  ASSERT_EQ(run(write_capture(frames), settings).status, 0);
  EXPECT_TRUE(all_bytes() == scans);
  ASSERT_EQ(run(can(), {}).status, 0);
  EXPECT_LT(greatest_distance(scan(2), odd), 0.02) << "a count is 0.1°";
}

TEST_F(Encoder, IsShownByInfo) {
  make_room({"--seconds", "0.2"});
  const Frames frames = with_encoder(drive_frame);
  const auto sent = std::count_if(frames.begin(), frames.end(),
                                  [](const can::CanFrame& frame) { return frame.id == kEncoder; });
  ASSERT_GT(sent, 10);
  const ProgramResult info = run_program(
      "convexcut", {"info", "--can", write_log(frames), "--json", "--set", "encoder.use=yaw",
                    "--set", "encoder.preset=cia402_position", "--set", "encoder.id=0x183"});
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("\"angles\": " + std::to_string(sent) + ","));
}

TEST_F(Encoder, WithoutABusItIsAWrongConfiguration) {
  make_room({"--seconds", "0.2"});
  const ProgramResult result =
      process({"--lidar", lidar(), "--imu", imu(), "--set", "encoder.use=yaw"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.error_lines(), 1U);
  EXPECT_THAT(result.err, HasSubstr("expected --can FILE"));
}

TEST_F(Encoder, ABusWithoutItsFramesIsSaid) {
  make_room({"--seconds", "0.2"});
  const ProgramResult result = run(can(), {"encoder.use=yaw"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.error_lines(), 1U);
  EXPECT_THAT(result.err, HasSubstr("no angle of the stage in it"));
  EXPECT_THAT(result.err, HasSubstr("0 of the encoder"));
}

TEST_F(Encoder, SerialImuAndEncoderOnTheBusGoTogether) {
  make_room({"--seconds", "0.5", "--turn-deg-s", "60"});
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu()}).status, 0);
  const replay::PcdCloud truth = scan(2);
  Frames frames = with_encoder(drive_frame);
  std::erase_if(frames, [](const can::CanFrame& frame) { return frame.id != kEncoder; });
  std::vector<std::string> arguments{"--lidar", lidar(),           "--imu", imu(),
                                     "--can",   write_log(frames), "--set", "encoder.use=yaw"};
  for (const std::string& setting : drive_settings) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  const ProgramResult result = process(arguments);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_LT(greatest_distance(scan(2), truth), kResolution_m);
}

}  // namespace
}  // namespace convexcut::test
