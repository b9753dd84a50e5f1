// SPDX-License-Identifier: Apache-2.0
//
// Poses from file to scan. Does not prove that a position that is given makes a method better.
#include <array>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "core/scan/position_track.hpp"
#include "drivers/recording/pose_file.hpp"
#include "tests/support/room.hpp"

namespace convexcut::test {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;
const std::string kHeader = "stamp_ns,x,y,z,qx,qy,qz,qw\n";

PoseSample pose(std::int64_t stamp_ns, double x, double y = 0.0, double z = 0.0) {
  return {from_ns<HostTime>(stamp_ns), Vec3(x, y, z), Quaternion::Identity()};
}

TEST(PositionTrack, IsOnTheStraightLineBetweenPoses) {
  const PositionTrack track({pose(0, 1.0, 0.0, 5.0), pose(kSecond / 2, 2.0, 4.0, 5.0)});
  EXPECT_EQ(track.at(from_ns<HostTime>(0)), Vec3(1.0, 0.0, 5.0));
  EXPECT_EQ(track.at(from_ns<HostTime>(kSecond / 8)), Vec3(1.25, 1.0, 5.0));
  EXPECT_EQ(track.at(from_ns<HostTime>(kSecond / 2)), Vec3(2.0, 4.0, 5.0));
}

TEST(PositionTrack, IsNowhereOutsideOfThePoses) {
  const PositionTrack track({pose(kSecond, 1.0), pose(kSecond + 1, 2.0)});
  EXPECT_FALSE(track.at(from_ns<HostTime>(kSecond - 1)));
  EXPECT_FALSE(track.at(from_ns<HostTime>(kSecond + 2)));
  EXPECT_FALSE(PositionTrack({}).at(from_ns<HostTime>(0)));
}

TEST(PositionTrack, IsNowhereInAGapOfMoreThanASecond) {
  const PositionTrack track({pose(0, 0.0), pose(kSecond, 1.0), pose(2 * kSecond + 1, 2.0)});
  EXPECT_TRUE(track.at(from_ns<HostTime>(kSecond / 2)));
  EXPECT_TRUE(track.at(from_ns<HostTime>(kSecond)));
  EXPECT_FALSE(track.at(from_ns<HostTime>(kSecond + 1)));
  EXPECT_TRUE(track.at(from_ns<HostTime>(2 * kSecond + 1)));
}

TEST(PositionTrack, RefusesStampsThatDoNotAscend) {
  EXPECT_THROW(PositionTrack({pose(5, 0.0), pose(5, 1.0)}), std::invalid_argument);
}

class PoseFile : public RoomTest {
 protected:
  [[nodiscard]] std::vector<PoseSample> read(const std::string& content) const {
    write(path("poses.csv"), content);
    return recording::read_poses(path("poses.csv"));
  }
  void expect_error(const std::string& content, const std::string& what) const {
    try {
      static_cast<void>(read(content));
      ADD_FAILURE() << "read: " << content;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("poses.csv"));
      EXPECT_THAT(error.what(), HasSubstr(what));
    }
  }
};

TEST_F(PoseFile, IsRead) {
  const auto poses = read(kHeader + "7,1.5,-2,3e-1,0,0,0.6,0.8\r\n8,0,0,0,0,0,0,1.0005\n");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(to_ns(poses[0].stamp), 7);
  EXPECT_EQ(poses[0].position_world, Vec3(1.5, -2.0, 0.3));
  EXPECT_DOUBLE_EQ(poses[0].q_world_from_lidar.z(), 0.6);
  EXPECT_DOUBLE_EQ(poses[0].q_world_from_lidar.w(), 0.8);
  EXPECT_DOUBLE_EQ(poses[1].q_world_from_lidar.w(), 1.0);
}

TEST_F(PoseFile, ErrorsNameTheLine) {
  const std::string good = "7,0,0,0,0,0,0,1\n";
  expect_error("", "no pose");
  expect_error(kHeader, "no pose");
  expect_error(good, ":1: expected the header");
  expect_error(kHeader + "x,0,0,0,0,0,0,1\n", ":2: expected eight numbers");
  expect_error(kHeader + good + "8,0,0,0,0,0,1\n", ":3: expected eight numbers");
  expect_error(kHeader + good + "8,0,0,0,0,0,0,1,2\n", ":3: expected eight numbers");
  expect_error(kHeader + good + "8,nan,0,0,0,0,0,1\n", ":3: expected eight numbers");
  expect_error(kHeader + good + "8,inf,0,0,0,0,0,1\n", ":3: expected eight numbers");
  expect_error(kHeader + good + "8,0,0,0,0,0,0,2\n", ":3: expected a rotation");
  expect_error(kHeader + good + "\n", ":3: expected eight numbers");
  expect_error(kHeader + good + good, ":3: expected a later stamp_ns");
  EXPECT_THROW(static_cast<void>(recording::read_poses(path("none.csv"))), std::runtime_error);
}

class ProcessPoses : public RoomTest {
 protected:
  // The stamps of the scans that were written.
  [[nodiscard]] std::vector<std::int64_t> stamps() const {
    std::istringstream rows(text(path("scans") / "scans.csv"));
    std::vector<std::int64_t> stamps;
    std::string row;
    std::getline(rows, row);
    while (std::getline(rows, row)) stamps.push_back(std::stoll(row.substr(row.find(',') + 1)));
    return stamps;
  }
  // VIEWPOINT of a scan's file.
  [[nodiscard]] std::array<double, 3> viewpoint(const std::string& scan) const {
    const std::string pcd = text(path("scans") / scan);
    std::istringstream words(pcd.substr(pcd.find("VIEWPOINT ") + 10, 100));
    std::array<double, 3> position{};
    for (double& value : position) words >> value;
    return position;
  }
  // Along x at 2 m/s from `begin`, for three seconds.
  void write_poses(std::int64_t begin) const {
    std::ostringstream csv;
    csv << kHeader;
    for (std::int64_t i = 0; i <= 30; ++i) {
      csv << begin + i * kSecond / 10 << ',' << 0.2 * static_cast<double>(i) << ",-1,1.5,0,0,0,1\n";
    }
    write(path("poses.csv"), csv.str());
  }
  [[nodiscard]] ProgramResult process_with_poses() const {
    return process({"--lidar", lidar(), "--imu", imu(), "--poses", path("poses.csv").string()});
  }
};

TEST_F(ProcessPoses, EveryScanCarriesThePositionAtItsStamp) {
  make_room({"--seconds", "0.5"});
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu()}).status, 0);
  EXPECT_EQ(viewpoint("scan_000001.pcd"), (std::array<double, 3>{0, 0, 0}));
  const std::vector<std::int64_t> scans = stamps();
  ASSERT_GE(scans.size(), 4U);
  const std::int64_t begin = scans.front() - kSecond / 4;
  write_poses(begin);
  const ProgramResult run = process_with_poses();
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(stamps(), scans);
  for (std::size_t i = 1; i < 4; ++i) {
    const auto position = viewpoint("scan_00000" + std::to_string(i) + ".pcd");
    const double moved = 2.0 * static_cast<double>(scans[i] - begin) / static_cast<double>(kSecond);
    EXPECT_NEAR(position[0], moved, 2e-6);
    EXPECT_EQ(position[1], -1.0);
    EXPECT_EQ(position[2], 1.5);
  }
}

TEST_F(ProcessPoses, ScansThatNoPoseReachesAreTold) {
  make_room({"--seconds", "0.3"});
  write_poses(kSecond);
  const ProgramResult run = process_with_poses();
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
  EXPECT_THAT(run.err, HasSubstr("have no position"));
  EXPECT_THAT(run.err, HasSubstr("poses.csv"));
}

TEST_F(ProcessPoses, AFileThatIsWrongStopsTheStart) {
  make_room({"--seconds", "0.1"});
  write(path("poses.csv"), kHeader + "1,2\n");
  const ProgramResult run = process_with_poses();
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
  EXPECT_THAT(run.err, HasSubstr("poses.csv:2: expected eight numbers"));
  EXPECT_EQ(names(path("scans")), std::vector<std::string>{});
}

TEST_F(ProcessPoses, TheDaemonTakesThemWithRecordingsOnly) {
  make_room({"--seconds", "0.3"});
  write_poses(kSecond);
  const std::string poses = path("poses.csv").string();
  const ProgramResult live = run_program("convexcutd", {"--poses", poses});
  EXPECT_EQ(live.status, 2);
  EXPECT_THAT(live.err, HasSubstr("--poses"));
  const ProgramResult far = run_program(
      "convexcutd", {"--lidar", lidar(), "--imu", imu(), "--poses", poses, "--rate", "max"});
  EXPECT_EQ(far.status, 0) << far.err;
  EXPECT_THAT(far.err, ::testing::ContainsRegex("without_position=[1-9]"));
}

}  // namespace
}  // namespace convexcut::test
